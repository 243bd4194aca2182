#pragma once

#include "job/job.h"
#include "strategy/run.h"

#include <optional>
#include <vector>

namespace fettle::strategy {

/// Force control in layer 1 (Wang 2007, 6.1.4.2): the feed is constant, and the force follows the depth of cut at each
/// point of a pass. By Preston's law a depth t at the feed v takes a force of t v / q, where q, depth times feed per
/// force, depends on metal and wheel, and on how much of the wheel's width meets metal: at the edge of a stub q is many
/// times what the job predicts. So both t and q are learned point by point, within the pass: t from the height above
/// the reference that the last stroke left, q from the force of the last stroke and the height that it removed. The
/// deeper the cut, the more of the width meets metal: q can only fall.
///
/// The spring makes the force: the drives go below the reference by the force offset, the deflection that gives this
/// force with the wheel at its target. A wheel above the target presses harder, one below it presses less: the share
/// k q / (v + k q) of an error of q is compensated at once.
///
/// The rim meets the stock ahead before the middle of the wheel does: t is how far above the wheel's lowest line the
/// rim leaves the metal ahead. The stock there is bounded by the rim at all its positions in the stroke before.
class ForceControl {
  public:
    /// @param max_remaining  largest height that may be left above the reference surface, mm
    /// @param known  that the job's coefficient was learnt: then strokes over places that taught nothing yet are
    /// controlled, too
    ForceControl(const job::Job& job, double max_remaining, const std::optional<KnownRemoval>& known = std::nullopt);

    /// Forgets the last pass.
    /// @param along  positions of the new pass's points, ascending, mm
    void begin_pass(const std::vector<double>& along);
    /// The wheel was moved without grinding: the next point does not continue the stroke.
    void interrupt_stroke();
    /// Records that the wheel has arrived at a point.
    /// @param remaining  height above the reference, mm   @param impulse  ∫F dt since the last point, N s
    void record(int point, double remaining, double impulse);
    /// Force offset at the next point of a stroke towards +1 or −1: how far below the reference the drives go, mm; 0 if
    /// nothing has been learned there. It grows no faster than `max_remaining` per contact length, so that the wheel
    /// can follow.
    double next_force_offset(int point, int direction);

  private:
    struct PointState {
        double remaining = 0;            ///< mm; NaN: not known
        double removed = 0, impulse = 0; ///< by the last stroke: depth times length, mm²; N s
    };
    struct PassQ {
        double along, q;
    };
    double desired_offset(int point, int direction) const;
    double cut_depth(int point, int direction, double tip) const;
    double stock_height(int point) const;
    double learned_q(int point) const;
    double expected_q(double along) const;
    double rim(double distance) const { return distance * distance / (2 * radius_); }

    double radius_, preload_, stiffness_, feed_;
    double max_force_;        ///< a larger force belongs to a layer above
    double target_;           ///< height to be left, mm
    double max_known_q_;      ///< of the whole width in stock that yields as easily as it may; 0: not known
    double min_q_;            ///< q of the whole width in stock as hard as the job says
    double contact_length_;   ///< points within it share one q, mm
    double max_offset_slope_; ///< growth of the force offset per length
    std::vector<double> along_;
    std::vector<PointState> points_;
    std::vector<PassQ> last_pass_;
    int last_point_ = -1;     ///< of the stroke; -1: none yet
    double force_offset_ = 0; ///< at the last point, mm
};

} // namespace fettle::strategy
