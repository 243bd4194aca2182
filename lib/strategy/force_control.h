#pragma once

#include "job/job.h"

#include <vector>

namespace fettle {

/// Force control in layer 1 (Wang 2007, 6.1.4.2): the feed is kept, and each place of a pass is pressed as hard as the
/// depth of cut there asks. By Preston's law a depth t at the feed v takes a force of t v / q, where q, depth times
/// feed per force, depends on metal and wheel, and on how much of the wheel's width meets metal: where it is the edge
/// of a stub, many times what the job says. So both t and q are learned place by place, within the pass: what stands
/// over the reference from the stroke before, q from the force of the last stroke and how much less stood after it than
/// before. The deeper, the more of the width meets metal: q can only fall.
///
/// The force is made by the spring: the drives go below the reference by what bends it so far with the wheel at its
/// target. A wheel that stands higher presses harder, one that sinks presses less: an error of q is made up for by the
/// share k q / (v + k q) at once.
///
/// The rim meets what stands ahead before the middle of the wheel does: t is how far above the wheel's lowest line the
/// rim leaves the metal ahead. What stands there is what the wheel, where it stood in the stroke before, left of it.
class ForceControl {
  public:
    /// @param remaining  the most that may be left, mm
    ForceControl(const Job& job, double remaining);

    /// @param along  places of the points, ascending, mm. Nothing is known of what stands there.
    void begin_pass(const std::vector<double>& along);
    /// Comes down on another place: nothing was ground on the way.
    void set_down();
    /// The wheel has gone on to a point and stands `remaining` over its reference, mm.
    /// @param impulse  ∫F dt on the way, N s
    void arrived(int point, double remaining, double impulse);
    /// How far below the reference the drives go at the next point, on the way towards +1 or −1, mm. 0 if nothing is
    /// known. It grows no faster than by what may remain over a contact length; the wheel has to follow.
    double press(int point, int direction);

  private:
    struct Known {
        double remaining = 0;          ///< mm; NaN: nothing is known
        double taken = 0, impulse = 0; ///< by the last stroke: depth times length, mm²; N s
    };
    double wanted(int point, int direction) const;
    double depth(int point, int direction, double tip) const;
    double stock(int point) const;
    double yield(int point) const;
    double rim(double distance) const { return distance * distance / (2 * radius_); }

    double radius_, preload_, stiffness_, feed_;
    double most_force_;  ///< beyond it a layer above is due
    double target_;      ///< to be left, mm
    double least_yield_; ///< q of the whole width in stock as hard as the job says
    double near_;        ///< places within it are one for q, mm
    double steepest_;    ///< that the drives go down, per length
    std::vector<double> along_;
    std::vector<Known> known_;
    int at_ = -1;
    double pressed_ = 0; ///< at the last point, mm
};

} // namespace fettle
