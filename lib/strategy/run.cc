#include "strategy/run.h"

#include "core/error.h"
#include "core/text.h"
#include "plan/tool_path.h"
#include "strategy/feed_control.h"
#include "strategy/force_control.h"
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
        : plan_(plan), gantry_(gantry), options_(options), path_(plan.job, plan.surface, plan.passes, plan.step),
          strategy_(path_.passes(), settings_of(plan, options)),
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
        record(action, gantry_.status(), 0);
        result_.finished = action.kind == Action::Kind::finish;
        result_.counts = strategy_.counts();
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

    // Until the strategy is done. `action`: the last one.
    void grind_on(Action& action, const Progress& progress)
    {
        while (action.kind != Action::Kind::finish && action.kind != Action::Kind::fail) {
            measure_wheel_if_due(action);
            const GantryStatus status = perform(action);
            if (strategy_.counts().steps % kStepsPerTell == 0)
                tell(progress, double(action.to.pass) / double(path_.passes().size()));
            action =
                strategy_.next({status.force + plan_.job.force.stiffness * short_of_, remaining(status), status.time});
        }
    }

    GantryStatus perform(const Action& action)
    {
        GantryStatus status = gantry_.status();
        const Place from = at_;
        at_ = action.to;
        switch (action.kind) {
        case Action::Kind::travel:
            status = travel(reference(action.to), action.layer);
            break;
        case Action::Kind::lift:
            pressed_ = 0;
            status = gantry_.lift(tool_point(action.layer).z());
            break;
        case Action::Kind::grind:
            if (from.pass != action.to.pass) return cross(action);
            if (by_force(action.layer)) pressed_ = force_control_.press(action.to.point, strategy_.direction());
            status = grind(reference(action.to), action.layer);
            break;
        default:
            break;
        }
        noticed(status, action);
        if (by_force(action.layer)) learn(action, status);
        record(action, status, action.kind == Action::Kind::grind ? feed_ : 0);
        return status;
    }

    void learn(const Action& action, const GantryStatus& status)
    {
        if (action.event != Event::none) force_control_.begin_pass(path_.passes()[action.to.pass].along);
        if (action.kind != Action::Kind::grind) return force_control_.set_down();
        const double impulse = (last_force_ + status.force) / 2 * (status.time - last_time_);
        force_control_.arrived(action.to.point, remaining(status), impulse);
    }

    // Of the stock over the reference surface.
    double remaining(const GantryStatus& status) const { return status.deflection + short_of_ - pressed_; }

    // Where the tool stands in this layer.
    Eigen::Vector3d tool_point(int layer) const
    {
        return standing_ + (raised(layer) - lost_ - pressed_) * Eigen::Vector3d::UnitZ();
    }

    GantryStatus travel(const Eigen::Vector3d& reference, int layer)
    {
        pressed_ = 0;
        standing_ = reference;
        return gantry_.travel(tool_point(layer));
    }

    GantryStatus grind(const Eigen::Vector3d& reference, int layer)
    {
        if (layer == 1 && options_.layer_1 == Layer1::feed) return grind_controlled(reference);
        standing_ = reference;
        feed_ = plan_.job.feed.rate;
        return gantry_.grind(tool_point(layer), feed_);
    }

    // In layer 1, period by period of the feed-rate control.
    GantryStatus grind_controlled(const Eigen::Vector3d& reference)
    {
        const Eigen::Vector3d from = standing_, way = reference - from;
        const double length = way.norm();
        GantryStatus status = gantry_.status();
        const double begun = status.time;
        double peak = 0;
        for (double gone = 0; gone < length && status.force <= plan_.job.force.max;) {
            gone = std::min(gone + feed_control_.feed() * feed_control_.period(), length);
            standing_ = from + way * (gone / length);
            const GantryStatus next = gantry_.grind(tool_point(1), feed_control_.feed());
            feed_control_.update(status.deflection, next.deflection, next.time - status.time);
            status = next;
            peak = std::max(peak, status.peak_force);
            feed_ = gone / (status.time - begun);
        }
        status.peak_force = std::max(status.peak_force, peak);
        return status;
    }

    // To the next pass in pieces of a step, over the surface between the two. It ends early, above the place that was
    // reached, if the wheel climbs on something that is too high: the strategy goes up a layer there and then on.
    GantryStatus cross(const Action& action)
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
        GantryStatus status;
        for (int i = 1; i <= pieces; ++i) {
            const double s = double(i) / pieces;
            const Eigen::Vector3d point = a + s * (b - a) + 4 * s * (1 - s) * crown * Eigen::Vector3d::UnitZ();
            status = grind(point, action.layer);
            noticed(status, action);
            Action piece = action;
            if (i > 1) piece.event = Event::none;
            record(piece, status, feed_);
            if (status.force > plan_.job.force.max) break;
        }
        return status;
    }

    // A guarded way down may have stopped above the reference surface. A step along it has not, though a machine with
    // look-ahead may still be on its way.
    void noticed(const GantryStatus& status, const Action& action)
    {
        const bool along = action.kind == Action::Kind::grind;
        short_of_ = along ? 0 : std::max(0.0, status.commanded.z() - tool_point(action.layer).z());
        result_.peak_force = std::max({result_.peak_force, status.force, status.peak_force});
    }

    void record(const Action& action, const GantryStatus& status, double feed)
    {
        result_.trace.push_back({status.time, status.commanded + status.deflection * Eigen::Vector3d::UnitZ(),
                                 action.layer, action.to.pass + 1, action.event, status.force, feed});
        const double ground = feed > 0 ? status.time - last_time_ : 0;
        grinding_time_ += ground;
        wear_.ground(status.force, ground);
        if (one_covering()) lost_ = wear_.loss();
        last_time_ = status.time;
        last_force_ = status.force;
    }

    void measure_wheel_if_due(const Action& action)
    {
        const bool covering = action.event == Event::start || action.event == Event::covering_done;
        const bool in_pass = action.kind == Action::Kind::grind && action.event == Event::none;
        const bool due = grinding_time_ - measured_at_ >= options_.touch_off_period ||
                         (one_covering() && action.layer == 1 && wear_.due());
        if (!covering && !(due && (in_pass || action.kind == Action::Kind::travel))) return;
        measure_wheel(action);
        if (in_pass) travel(reference(at_), action.layer); // back to where it was
    }

    void measure_wheel(Action action)
    {
        const double least = plan_.job.wheel.min_radius;
        double radius = touch_off(action);
        if (radius < least) {
            gantry_.change_wheel();
            wear_.renewed();
            ++result_.wheel_changes;
            action.event = Event::wheel_change;
            record(action, gantry_.status(), 0);
            radius = touch_off(action);
            if (radius < least)
                throw InputError(plan_.job.source, "wheel.min_radius: a new wheel measures " +
                                                       to_short_text(radius / plan_.job.units.mm()));
        }
        if (radius != result_.wheel_radius) path_.set_radius(radius);
        result_.wheel_radius = radius;
        measured_at_ = grinding_time_;
    }

    double touch_off(Action action)
    {
        const double radius = gantry_.touch_off();
        ++result_.touch_offs;
        wear_.measured(radius);
        lost_ = 0;
        action.event = Event::touch_off;
        record(action, gantry_.status(), 0);
        return radius;
    }

    const Plan& plan_;
    Gantry& gantry_;
    RunOptions options_;
    ToolPath path_;
    LayerSwitching strategy_;
    FeedControl feed_control_;
    ForceControl force_control_;
    WheelWear wear_;
    GrindRun result_;
    Place at_;
    Eigen::Vector3d standing_ = Eigen::Vector3d::Zero(); ///< tool point in layer 1 where the tool stands
    double lost_ = 0;     ///< by the wheel since it was measured, mm; only where one covering has to be enough
    double pressed_ = 0;  ///< how far the drives are below the reference for the force that is wanted, mm
    double feed_ = 0;     ///< of the last step, mm/s
    double short_of_ = 0; ///< how far above its reference, mm
    double grinding_time_ = 0, measured_at_ = 0, last_time_ = 0, last_force_ = 0;
};

} // namespace

GrindRun run(const Plan& plan, Gantry& gantry, const RunOptions& options, const Progress& progress)
{
    return Runner(plan, gantry, options).run(progress);
}

} // namespace fettle
