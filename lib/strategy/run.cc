#include "strategy/run.h"

#include "core/error.h"
#include "core/text.h"
#include "plan/tool_path.h"
#include "strategy/feed_control.h"
#include "strategy/force_control.h"
#include "strategy/recorder.h"
#include "strategy/wheel_wear.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// Progress is told once in so many steps.
constexpr int kStepsPerTell = 256;

LayerSwitching::Settings settings_of(const Plan& plan, const RunOptions& options)
{
    LayerSwitching::Settings settings = strategy_settings(plan);
    settings.finish_passes = options.layer_1 != Layer1::constant;
    return settings;
}

class Runner {
  public:
    Runner(const Plan& plan, Gantry& gantry, const RunOptions& options)
        : plan_(plan), options_(options),
          machine_(gantry, plan.job.units, options.done, options.done_source, options.journal),
          path_(plan.job, plan.surface, plan.passes, plan.step), strategy_(path_.passes(), settings_of(plan, options)),
          feed_control_(plan.job, strategy_settings(plan).remaining),
          force_control_(plan.job, strategy_settings(plan).remaining),
          wear_(plan.job, strategy_settings(plan).remaining)
    {
    }

    GrindRun run(const Progress& progress)
    {
        Action action = strategy_.first();
        try {
            grind_on(action, progress);
            result_.failure = strategy_.failure();
        } catch (const GantryFault& fault) {
            action.kind = Action::Kind::fail;
            action.event = Event::fault;
            result_.failure = fault.what();
        }
        machine_.decide(mark(action, action.event));
        result_.finished = action.kind == Action::Kind::finish;
        result_.counts = strategy_.counts();
        result_.trace = machine_.trace();
        return std::move(result_);
    }

  private:
    bool one_covering() const { return options_.layer_1 != Layer1::constant; }
    bool by_force(int layer) const { return layer == 1 && options_.layer_1 == Layer1::force; }
    double raised(int layer) const { return reference_offset(plan_.layers, layer); }
    const Eigen::Vector3d& reference(const Place& place) const
    {
        return path_.passes()[place.pass].points[place.point];
    }

    static Recorder::Mark mark(const Action& action, Event event) { return {action.layer, action.to.pass + 1, event}; }

    // Until the strategy is done. `action`: the last one.
    void grind_on(Action& action, const Progress& progress)
    {
        while (action.kind != Action::Kind::finish && action.kind != Action::Kind::fail) {
            measure_wheel_if_due(action);
            perform(action);
            if (strategy_.counts().steps % kStepsPerTell == 0)
                tell(progress, double(action.to.pass) / double(path_.passes().size()));
            const GantryStatus& status = machine_.status();
            action =
                strategy_.next({status.force + plan_.job.force.stiffness * short_of_, remaining(status), status.time});
        }
    }

    void perform(const Action& action)
    {
        const Place from = at_;
        at_ = action.to;
        event_ = action.event;
        switch (action.kind) {
        case Action::Kind::travel:
            travel(action, reference(action.to));
            break;
        case Action::Kind::lift:
            pressed_ = 0;
            go_on_from_trace(action);
            moved(machine_.lift(mark(action, event_), tool_point(action.layer).z()), action.layer, 0);
            break;
        case Action::Kind::grind:
            if (from.pass != action.to.pass) return cross(action);
            if (by_force(action.layer)) pressed_ = force_control_.press(action.to.point, strategy_.direction());
            grind(action, reference(action.to));
            break;
        default:
            machine_.decide(mark(action, event_));
            break;
        }
        if (by_force(action.layer)) learn(action);
    }

    void learn(const Action& action)
    {
        if (action.event != Event::none) force_control_.begin_pass(path_.passes()[action.to.pass].along);
        if (action.kind != Action::Kind::grind) return force_control_.set_down();
        force_control_.arrived(action.to.point, remaining(machine_.status()), impulse_);
    }

    // Of the stock over the reference surface.
    double remaining(const GantryStatus& status) const { return status.deflection + short_of_ - pressed_; }

    // Where the tool stands in this layer.
    Eigen::Vector3d tool_point(int layer) const
    {
        return standing_ + (raised(layer) - lost_ - pressed_) * Eigen::Vector3d::UnitZ();
    }

    void travel(const Action& action, const Eigen::Vector3d& reference)
    {
        pressed_ = 0;
        standing_ = reference;
        go_on_from_trace(action);
        moved(machine_.travel(mark(action, event_), tool_point(action.layer)), action.layer, 0);
    }

    void grind(const Action& action, const Eigen::Vector3d& reference)
    {
        if (action.layer == 1 && options_.layer_1 == Layer1::feed) return grind_controlled(action, reference);
        standing_ = reference;
        grind_at(action, plan_.job.feed.rate);
    }

    // On to where the tool is to stand.
    void grind_at(const Action& action, double feed)
    {
        go_on_from_trace(action);
        moved(machine_.grind(mark(action, event_), tool_point(action.layer), feed), action.layer, feed);
        event_ = Event::none;
    }

    // In layer 1, period by period of the feed-rate control.
    void grind_controlled(const Action& action, const Eigen::Vector3d& reference)
    {
        const Eigen::Vector3d from = standing_, way = reference - from;
        const double length = way.norm();
        for (double gone = 0; gone < length && machine_.status().force <= plan_.job.force.max;) {
            gone = std::min(gone + feed_control_.feed() * feed_control_.period(), length);
            standing_ = from + way * (gone / length);
            const GantryStatus before = machine_.status();
            grind_at(action, feed_control_.feed());
            const GantryStatus& after = machine_.status();
            feed_control_.update(before.deflection, after.deflection, after.time - before.time);
        }
    }

    // To the next pass in pieces of a step, over the surface between the two. It ends early, above the place that was
    // reached, if the wheel climbs on something that is too high: the strategy goes up a layer there and then on.
    void cross(const Action& action)
    {
        const Eigen::Vector3d a = standing_, b = reference(action.to);
        const int pieces = std::max(1, int(std::ceil((b - a).head<2>().norm() / plan_.step)));
        pressed_ = 0;
        force_control_.begin_pass(path_.passes()[action.to.pass].along);
        // The path between is a parabola through the tool point half-way: a straight line would cut into a crown.
        double crown = 0;
        if (pieces > 1) {
            const Eigen::Vector3d middle = path_.tool_point(path_.across_along((a + b) / 2));
            if (std::isfinite(middle.z())) crown = middle.z() - (a.z() + b.z()) / 2;
        }
        for (int i = 1; i <= pieces && (i == 1 || machine_.status().force <= plan_.job.force.max); ++i) {
            const double s = double(i) / pieces;
            grind(action, a + s * (b - a) + 4 * s * (1 - s) * crown * Eigen::Vector3d::UnitZ());
        }
    }

    // A move is done. A guarded way down may have stopped above the reference surface. A step along it has not, though
    // a machine with look-ahead may still be on its way.
    void moved(const GantryStatus& status, int layer, double feed)
    {
        short_of_ = feed > 0 ? 0 : std::max(0.0, status.commanded.z() - tool_point(layer).z());
        result_.peak_force = std::max({result_.peak_force, status.force, status.peak_force});
        const double ground = feed > 0 ? status.time - last_time_ : 0;
        impulse_ = (last_force_ + status.force) / 2 * ground;
        grinding_time_ += ground;
        wear_.ground(status.force, ground);
        if (one_covering()) lost_ = wear_.loss();
        last_time_ = status.time;
        last_force_ = status.force;
    }

    // Where the trace of a run that was cut off ends, nobody knows where the machine is and what wheel it has.
    void go_on_from_trace(const Action& action)
    {
        if (!machine_.resumes() && !machine_.resumed()) return;
        const Eigen::Vector3d place = machine_.status().commanded;
        if (machine_.resumes()) machine_.go_live();
        measure_wheel(action);
        if (action.kind != Action::Kind::travel) machine_.travel(mark(action, Event::none), place);
        last_time_ = machine_.status().time;
    }

    void measure_wheel_if_due(const Action& action)
    {
        const bool covering = action.event == Event::start || action.event == Event::covering_done;
        const bool in_pass = action.kind == Action::Kind::grind && action.event == Event::none;
        const bool due = grinding_time_ - measured_at_ >= options_.touch_off_period ||
                         (one_covering() && action.layer == 1 && wear_.due());
        if (!covering && !(due && (in_pass || action.kind == Action::Kind::travel))) return;
        measure_wheel(action);
        if (!in_pass) return;
        event_ = Event::none;
        travel({Action::Kind::travel, Event::none, at_, action.layer}, reference(at_)); // back to where it was
    }

    void measure_wheel(const Action& action)
    {
        const double least = plan_.job.wheel.min_radius;
        double radius = touch_off(action);
        if (radius < least) {
            machine_.change_wheel(mark(action, Event::wheel_change));
            wear_.renewed();
            ++result_.wheel_changes;
            radius = touch_off(action);
            if (radius < least)
                throw InputError(plan_.job.source, "wheel.min_radius: a new wheel measures " +
                                                       to_short_text(radius / plan_.job.units.mm()));
        }
        if (radius != result_.wheel_radius) path_.set_radius(radius);
        result_.wheel_radius = radius;
        measured_at_ = grinding_time_;
    }

    double touch_off(const Action& action)
    {
        const double radius = machine_.touch_off(mark(action, Event::touch_off));
        ++result_.touch_offs;
        wear_.measured(radius);
        lost_ = 0;
        last_time_ = machine_.status().time;
        return radius;
    }

    const Plan& plan_;
    RunOptions options_;
    Recorder machine_;
    ToolPath path_;
    LayerSwitching strategy_;
    FeedControl feed_control_;
    ForceControl force_control_;
    WheelWear wear_;
    GrindRun result_;
    Place at_;
    Eigen::Vector3d standing_ = Eigen::Vector3d::Zero(); ///< tool point in layer 1 where the tool stands
    double lost_ = 0;           ///< by the wheel since it was measured, mm; only where one covering has to be enough
    double pressed_ = 0;        ///< how far the drives are below the reference for the force that is wanted, mm
    double impulse_ = 0;        ///< ∫F dt of the last step, N s
    Event event_ = Event::none; ///< that the next row tells
    double short_of_ = 0;       ///< how far above its reference, mm
    double grinding_time_ = 0, measured_at_ = 0, last_time_ = 0, last_force_ = 0;
};

} // namespace

GrindRun run(const Plan& plan, Gantry& gantry, const RunOptions& options, const Progress& progress)
{
    return Runner(plan, gantry, options).run(progress);
}

} // namespace fettle
