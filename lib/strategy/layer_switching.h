#pragma once

#include "job/job.h"
#include "plan/plan.h"
#include "plan/tool_path.h"

#include <functional>
#include <string>
#include <vector>

namespace fettle::strategy {

/// Decision of the strategy. Its number is the value of the field `event` of a trace (docs/formats.md).
enum class Event {
    none = 0,          ///< a step along a pass
    start = 1,         ///< travel to the initial point
    up = 2,            ///< F > F_max: up one layer in place
    down = 3,          ///< F_a ≤ F_down: down one layer, back to where it was left
    step_over = 4,     ///< to the next pass
    cut_end = 5,       ///< F < F_min at the beginning of a pass, or no pass is left
    re_cut = 6,        ///< F_a > F_down: back to where this layer was entered
    covering_done = 7, ///< layer 1 has covered all of B, not within tolerance: travel to the start
    finished = 8,      ///< layer 1 has covered all of B within tolerance
    limit_reached = 9, ///< a limit was reached: the work ends unfinished
    touch_off = 10,    ///< the wheel's radius was measured at P0 (run.h)
    wheel_change = 11, ///< a new wheel (run.h)
    fault = 12,        ///< the machine stopped (run.h)
    in_progress = 13,  ///< the action was started; its result is not known (trace_file.h)
    stopped = 14,      ///< the operator stopped the machine; the wheel was lifted (run.h)
    roughed = 15,      ///< layer 1 is ground on lines a step-over apart: travel to the start of the first covering
};

/// A point of the staircase: index of the pass, and of the point in it.
struct PathIndex {
    int pass = 0;
    int point = 0;
    bool operator==(const PathIndex&) const = default;
};

/// Measurement at the end of the last action.
struct Measurement {
    double force = 0;     ///< N; after a guarded descent, extrapolated to the target position
    double remaining = 0; ///< height of the stock above the reference surface under the wheel, mm
    double time = 0;      ///< of the machine, s
};

/// The next action of the machine.
struct Action {
    enum class Kind {
        grind,  ///< on the surface, to `to`: the next point of the pass, or across to the next pass
        travel, ///< without grinding, to `to`
        lift,   ///< in place, to `layer`
        stay,   ///< nothing moves; a decision to be recorded
        finish, ///< done
        fail    ///< a limit was reached
    };
    Kind kind = Kind::stay;
    Event event = Event::none;
    PathIndex to;
    int layer = 1;
};

/// Predictions of the largest force, N, while the wheel grinds in `layer` from point to point. An empty function
/// predicts nothing.
using ForcePrediction = std::function<double(const std::vector<PathIndex>& points, int layer)>;
struct ForcePredictions {
    ForcePrediction upper_bound; ///< for the hardest stock
    ForcePrediction expected;    ///< for the removal coefficient of the job
};

struct StrategyCounts {
    int highest_layer = 1;
    int coverings = 0; ///< complete coverings of layer 1
    int re_cuts = 0;
    int skipped_re_cuts = 0; ///< predicted not to exceed F_down
    int raises = 0;          ///< changes to the next higher layer
    int passes = 0;          ///< started, in any layer
    int strokes = 0;         ///< repeated strokes over a pass of layer 1
    int steps = 0;
};

/// The layer-switching strategy (Wang 2007, 5.3.2 and fig. 5-7) as a state machine: one measured force in, one action
/// out. It knows no machine.
///
/// 1. F > F_max: up one layer in place, again until the force is in range. The position where the lower layer was left
///    is kept on a stack.
/// 2. Layer 1 covers all of B. If it has lines closer than the step-over, a covering on lines about a step-over apart
///    comes first. A covering that leaves no more than the tolerance finishes the work; else the next one starts. With
///    `finish_passes` the wheel instead repeats strokes over the stretch of a pass where more is left, before the next
///    pass. With `skip_finished_passes` a covering leaves out the passes on which the one before it left no more.
/// 3. Above layer 1, F < F_min ends a pass: the wheel steps over and reverses. F < F_min at the beginning of a pass
///    ends the cut. If the cut's largest force F_a exceeds F_down, it is repeated from where this layer was entered;
///    else the wheel goes down one layer, to the position where that was left, and continues in its direction. A
///    repetition that is predicted not to exceed F_down is skipped, and so is the beginning of a pass, or the rest of
///    it, where the force is expected to stay below F_min.
///
/// The beginning of a pass is its first stretch, as long as the step-over, so that an edge of the anomaly that recedes
/// by up to 45° from pass to pass is still followed. Lines closer than the step-over serve the finish of layer 1: they
/// are skipped above it, and in its first covering.
class LayerSwitching {
  public:
    struct Settings {
        double force_min = 0, force_down = 0, force_max = 0; ///< N
        double step_over = 0;                                ///< mm
        double max_remaining = 0;                            ///< height that may be left after a covering, mm
        bool ends_at_safe_height = false;                    ///< the layer above the bound is at the safe height
        bool finish_passes = false;                          ///< finish each pass of layer 1 before the next
        bool skip_finished_passes = false;                   ///< grind only unfinished passes of layer 1 again
        plan::StrategyLimits bounds;
    };

    /// @param passes  must outlive the strategy; only their lines, positions and intervals are used
    LayerSwitching(const std::vector<plan::ToolPass>& passes, const Settings& settings,
                   ForcePredictions predictions = {});

    Action first();
    Action next(const Measurement& measurement);

    /// Whether layer 1 is being covered on lines about a step-over apart.
    bool is_roughing() const { return roughing_ && layer() == 1; }

    int layer() const { return int(levels_.size()); }
    int direction() const { return levels_.back().direction; } ///< +1: towards larger `along`
    const StrategyCounts& counts() const { return counts_; }
    /// The limit that was reached, and the state, after Kind::fail.
    const std::string& failure() const { return failure_; }

  private:
    /// A layer on the stack. Each but the last was left for the next higher layer at `at`.
    struct Level {
        PathIndex entered;
        int entry_direction;
        PathIndex at;
        int direction;
        bool met_metal;    ///< F ≥ F_min somewhere in this pass
        double pass_start; ///< `along` where the pass began
        double max_force;  ///< F_a of the cut
        int re_cuts;
        std::vector<PathIndex> cut = {}; ///< the points of the cut so far
    };
    Level level_from(const PathIndex& at, int direction, bool met_metal, int re_cuts) const
    {
        return {at, direction, at, direction, met_metal, along(at), 0, re_cuts};
    }
    Action act(Action::Kind kind, Event event) const { return {kind, event, levels_.back().at, layer()}; }
    Action fail(const std::string& limit);
    Action raise_layer();
    Action advance_in_layer_1(double remaining);
    bool turn_back(double remaining);
    void begin_pass();
    void start_stroke(int end);
    int last_point() const { return last_point(levels_.back().at.pass); }
    int last_point(int pass) const { return int(passes_[pass].along.size()) - 1; }
    Action advance_above_layer_1(double force);
    bool starts_below_force_min(const PathIndex& from, int direction, double pass_start) const;
    Action end_cut();
    bool needs_re_cut(const Level& level) const;
    Action start_covering(Event event);
    Action end_covering();
    int unfinished_pass(int first) const;
    bool has_close_lines() const;
    Action step_over_to(int pass, int point, bool met_metal);

    int farthest_pass(int pass) const;
    int nearest_point(int pass, double along) const;
    int interval_of(int pass, int point) const;
    double along(const PathIndex& at) const { return passes_[at.pass].along[at.point]; }

    const std::vector<plan::ToolPass>& passes_;
    Settings settings_;
    ForcePredictions predictions_;
    std::vector<Level> levels_; ///< stack of layers 1, 2, …; the last is the current one
    bool cut_ended_ = false;
    bool roughing_ = false;
    /// Largest height on each pass when it was last covered, mm; 0 where strokes were repeated until it was finished.
    std::vector<double> remaining_;
    /// State of a pass in layer 1 with finish_passes: first and last point of the current stroke where too much is
    /// left, its end point, and the number of repeated strokes.
    int first_high_ = 0, last_high_ = -1, stroke_end_ = -1, strokes_ = 0;
    StrategyCounts counts_;
    std::string failure_;
};

/// Settings of the strategy for a plan, with every pass in every covering. The share plan::kScallopPerTolerance of the
/// tolerance is reserved for the scallops between the passes.
LayerSwitching::Settings strategy_settings(const plan::Plan& plan);

} // namespace fettle::strategy
