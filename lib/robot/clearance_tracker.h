#pragma once

#include "robot/cell.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fettle::robot {

/// Minimum clearance of a cell at the steps of a path and between them, by conservative advancement: a clearance that
/// was measured, less the distance that the pair's bodies have travelled since, is a lower bound. A pair is measured
/// again only when its bound falls below the smallest clearance of the step; the results are those of measuring all
/// pairs at every step. FCL has conservative advancement for one pair of bodies; here the smallest clearance of one
/// pair spares the others.
class ClearanceTracker {
  public:
    /// The cell must outlive it.
    explicit ClearanceTracker(const Cell& cell);

    /// Advances to the next joints of the path. @return  the minimum clearance there, as far as
    /// CollisionOptions::max_clearance
    CellClearance advance(const CellJoints& joints);
    /// Minimum clearance on the motion from the previous step to the last one, joints moving linearly: a lower bound,
    /// see check_path(). There must have been two steps since the last reset.
    CellClearance swept_clearance();
    /// Forgets the path: the next step is not connected to the last one.
    void reset() { step_count_ = 0; }

    std::size_t step_count() const { return step_count_; }         ///< since the last reset
    std::size_t midpoint_count() const { return midpoint_count_; } ///< configurations measured between steps

  private:
    /// Result of measuring a clearance. It is exact if it is below `measured_to`, else a lower bound.
    struct Bound {
        double clearance = -core::kInfinity;   ///< mm; not cut off at CollisionOptions::max_clearance
        double measured_to = -core::kInfinity; ///< larger clearances were not measured, mm

        /// True if the clearance is exact, or known to exceed `limit`, mm.
        bool is_measured_up_to(double limit) const { return clearance < measured_to || measured_to >= limit; }
    };
    struct State {
        CellJoints joints = CellJoints::Zero();
        CellState cell_state;
        std::vector<Bound> bounds;         ///< by pair
        std::vector<double> motion_bounds; ///< by body: of its motion to this state, mm; NaN: not yet computed
        std::vector<std::size_t> pairs;    ///< of a midpoint: those whose motion is bisected there
    };
    /// Minimum of the swept clearances of a motion, as far as its pairs have been processed.
    struct Sweep {
        CellClearance minimum;
        double upper_bound = core::kInfinity; ///< of the result: the smallest clearance measured on the motion, mm
    };
    void measure(State& state, std::size_t pair, double max_clearance);
    bool renew_bound(std::size_t pair, double required, double look_ahead);
    void set_current_bound(std::size_t pair, double lower_bound);
    double clearance_lower_bound(std::size_t pair) const;
    double body_motion_bound(const State& from, State& to, std::size_t pair) const;
    void raise_bound(State& state, std::size_t pair) const;
    void sweep(State& from, State& to, std::span<const std::size_t> pairs, std::size_t bisections, Sweep& result);
    bool sweep_pair(State& from, State& to, std::size_t pair, std::size_t bisections, Sweep& result);
    void place_midpoint(const State& from, const State& to, State& middle);

    const Cell& cell_;
    State previous_, current_;
    std::vector<State> midpoints_;                 ///< by the number of bisections
    std::vector<double> step_displacement_;        ///< by body: upper bound since the previous step, mm
    std::vector<double> distance_travelled_;       ///< by body: upper bound since the last reset, mm
    std::vector<double> clearance_bound_at_reset_; ///< by pair: lower bound of the clearance, mm, after the distances
                                                   ///< that both bodies have travelled since the reset are subtracted
    std::size_t nearest_pair_ = 0;                 ///< the pair with the minimum clearance at the last step
    std::size_t step_count_ = 0, midpoint_count_ = 0;
};

} // namespace fettle::robot
