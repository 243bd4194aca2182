#pragma once

#include "job/job.h"
#include "plan/plan.h"
#include "plan/tool_path.h"

#include <string>
#include <vector>

namespace fettle {

/// What the strategy decided; a number in the field `event` of a trace (docs/formats.md).
enum class Event {
    none = 0,          ///< a step along a pass
    start = 1,         ///< to the initial point
    up = 2,            ///< F > F_max: up one layer in place
    down = 3,          ///< F_a ≤ F_down: down one layer, back to where it was left
    step_over = 4,     ///< to the next pass
    cut_end = 5,       ///< F < F_min at the beginning of a pass, or no pass is left
    re_cut = 6,        ///< F_a > F_down: back to where this layer was entered
    covering_done = 7, ///< layer 1 has covered all of B, and is not within tolerance: to the start
    finished = 8,      ///< layer 1 has covered all of B within tolerance
    bound = 9,         ///< a bound was reached: the work ends unfinished
    touch_off = 10,    ///< the wheel's radius was measured at P0 (run.h)
    wheel_change = 11, ///< a new wheel (run.h)
    fault = 12,        ///< the machine stopped (run.h)
    begun = 13,        ///< the machine was about to do it (trace_file.h)
};

/// A point of the staircase: index of the pass, index of its point.
struct Place {
    int pass = 0;
    int point = 0;
    bool operator==(const Place&) const = default;
};

/// What the machine measured at the end of the last action.
struct Measurement {
    double force = 0;     ///< N; after a guarded way down, what it would be at the place that was asked for
    double remaining = 0; ///< of the stock over the reference surface under the wheel: the spring's deflection, mm
    double time = 0;      ///< of the machine, s
};

/// What to do next.
struct Action {
    enum class Kind {
        grind,  ///< on the surface, to `to`: the next point of the pass, or across to the next pass
        travel, ///< without grinding, to `to`
        lift,   ///< in place, to `layer`
        stay,   ///< nothing moves; a decision to be recorded
        finish, ///< done
        fail    ///< a bound was reached
    };
    Kind kind = Kind::stay;
    Event event = Event::none;
    Place to;
    int layer = 1;
};

/// How often things happened.
struct StrategyCounts {
    int highest_layer = 1;
    int coverings = 0; ///< of layer 1, complete
    int re_cuts = 0;
    int raises = 0;
    int passes = 0;  ///< begun, in any layer
    int strokes = 0; ///< back over a pass of layer 1
    int steps = 0;
};

/// The layer-switching strategy (Wang 2007, 5.3.2 and fig. 5-7) as a state machine: one measured force in, one action
/// out. It knows no machine.
///
/// 1. F > F_max: up one layer in place, again until the force is in range. Where the lower layer was left is kept; the
///    layers nest.
/// 2. Layer 1 covers all of B. At its end, within tolerance: done; else once more from the start. Or, with
///    `finish_passes`, each pass goes to and fro over the stretch where more is left, until none is, before the next.
/// 3. Above layer 1, F < F_min ends a pass: step over, reverse. F < F_min at the beginning of a pass ends the cut. Its
///    largest force F_a > F_down: cut again from where this layer was entered; else down one layer, to the point where
///    that was left, and on in the direction it had.
///
/// The beginning of a pass is its first stretch, as long as the step-over: the edge of an anomaly may recede as steeply
/// as 45° from pass to pass and is still followed. Above layer 1 the lines of the staircase that stand closer than the
/// step-over are passed over; they are for the finish of layer 1.
class LayerSwitching {
  public:
    struct Settings {
        double force_min = 0, force_down = 0, force_max = 0; ///< N
        double step_over = 0;                                ///< mm
        double remaining = 0;                                ///< largest that may be left at the end of a covering, mm
        bool finish_passes = false;                          ///< in layer 1, one by one
        Bounds bounds;
    };

    /// @param passes  their lines, places and intervals; must outlive the strategy
    LayerSwitching(const std::vector<ToolPass>& passes, const Settings& settings);

    Action first();
    Action next(const Measurement& measurement);

    int layer() const { return int(levels_.size()); }
    const Place& place() const { return levels_.back().at; }
    int direction() const { return levels_.back().direction; } ///< +1: along ascends
    const StrategyCounts& counts() const { return counts_; }
    /// After Kind::fail: which bound, in which state.
    const std::string& failure() const { return failure_; }

  private:
    /// A layer that has been entered. All but the last were left upwards, at `at`.
    struct Level {
        Place entered;
        int entry_direction;
        Place at;
        int direction;
        bool met_metal;    ///< the pass has: F ≥ F_min
        double pass_begun; ///< along, where the pass began
        double most_force; ///< F_a of the cut
        int re_cuts;
    };
    Action act(Action::Kind kind, Event event) const { return {kind, event, levels_.back().at, layer()}; }
    Action fail(const std::string& bound);
    Action go_up();
    Action go_on_in_layer_1(double remaining);
    bool turn_back(double remaining);
    void begin_pass();
    void start_stroke(int end);
    int last_point() const; ///< of the current pass
    Action go_on_above(double force);
    Action end_cut();
    Action start_covering(Event event);
    Action step_over_to(int pass, int point, bool met_metal);

    int next_pass() const;
    int nearest_point(int pass, double along) const;
    int interval_of(int pass, int point) const;
    double along(const Place& place) const { return passes_[place.pass].along[place.point]; }

    const std::vector<ToolPass>& passes_;
    Settings settings_;
    std::vector<Level> levels_; ///< of layers 1, 2, …; the last is the current one
    bool cut_ended_ = false;
    double worst_remaining_ = 0; ///< in this covering
    /// Layer 1, finish_passes: of the current stroke, the first and the last point where too much is left, and where it
    /// ends; strokes of this pass.
    int high_first_ = 0, high_last_ = -1, stroke_end_ = -1, strokes_ = 0;
    StrategyCounts counts_;
    std::string failure_;
};

/// What a plan means for the strategy: the other half of the tolerance is what may stand between the passes.
LayerSwitching::Settings strategy_settings(const Plan& plan);

} // namespace fettle
