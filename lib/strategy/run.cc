#include "strategy/run.h"

#include "core/error.h"
#include "core/text.h"
#include "plan/tool_path.h"
#include "strategy/contact_watch.h"
#include "strategy/feed_control.h"
#include "strategy/force_control.h"
#include "strategy/recorder.h"
#include "strategy/wheel_wear.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle::strategy {
namespace {

constexpr int kStepsPerProgress = 256;

class Runner {
  public:
    Runner(const plan::Plan& plan, gantry::Gantry& gantry, const RunOptions& options)
        : plan_(plan), options_(options),
          machine_(gantry, plan.job.units, options.previous_trace, options.previous_source, options.journal),
          path_(plan.job, plan.surface, plan.passes, plan.step), settings_(strategy_settings(plan, single_covering())),
          strategy_(path_.passes(), settings_), feed_control_(plan.job, settings_.max_remaining),
          force_control_(plan.job, settings_.max_remaining), wear_model_(plan.job, settings_.max_remaining)
    {
        if (options.known_stock != nullptr) contact_watch_.emplace(*options.known_stock, plan.job);
    }

    GrindRun run(const core::Progress& progress)
    {
        Action action = strategy_.first();
        try {
            grind_until_done(action, progress);
            machine_.decide(mark(action, action.event));
            result_.failure = strategy_.failure();
            result_.finished = action.kind == Action::Kind::finish;
        } catch (const gantry::Interrupted& stop) {
            result_.failure = stop.what();
            retract(action);
        } catch (const gantry::GantryFault& fault) {
            fail(action, fault);
        }
        result_.counts = strategy_.counts();
        result_.trace = machine_.trace();
        return std::move(result_);
    }

  private:
    bool single_covering() const { return options_.layer_1 != Layer1::constant; }
    bool by_force(int layer) const { return layer == 1 && options_.layer_1 == Layer1::force; }
    const Eigen::Vector3d& reference(const PathIndex& position) const
    {
        return path_.passes()[position.pass].points[position.point];
    }

    static Recorder::Mark mark(const Action& action, Event event) { return {action.layer, action.to.pass + 1, event}; }

    void fail(const Action& action, const gantry::GantryFault& fault)
    {
        machine_.record_fault(mark(action, Event::fault));
        result_.failure = fault.what();
    }

    void retract(const Action& action)
    {
        try {
            machine_.retract(mark(action, Event::stopped), plan_.job.safe_height);
            result_.stopped = true;
        } catch (const gantry::GantryFault& fault) {
            fail(action, fault);
        }
    }

    /// @param action  the last one when the strategy is done, or the machine has stopped
    void grind_until_done(Action& action, const core::Progress& progress)
    {
        while (action.kind != Action::Kind::finish && action.kind != Action::Kind::fail) {
            measure_wheel_if_due(action);
            perform(action);
            if (options_.watch) options_.watch(machine_.trace().back());
            if (strategy_.counts().steps % kStepsPerProgress == 0)
                core::report_progress(progress, double(action.to.pass) / double(path_.passes().size()));
            const gantry::GantryStatus& status = machine_.status();
            action = strategy_.next(
                {status.force + plan_.job.force.stiffness * height_error_, remaining(status), status.time});
        }
    }

    void perform(const Action& action)
    {
        const PathIndex from = at_;
        at_ = action.to;
        event_ = action.event;
        switch (action.kind) {
        case Action::Kind::travel:
            travel(action, reference(action.to));
            break;
        case Action::Kind::lift:
            force_offset_ = 0;
            resume_from_trace(action);
            record_move(machine_.lift(mark(action, event_), tool_point(action.layer).z()), action.layer, 0);
            break;
        case Action::Kind::grind:
            if (from.pass != action.to.pass) return cross(action);
            if (by_force(action.layer))
                force_offset_ = force_control_.next_force_offset(action.to.point, strategy_.direction());
            grind(action, reference(action.to));
            break;
        default:
            machine_.decide(mark(action, event_));
            break;
        }
        if (by_force(action.layer)) update_force_control(action);
    }

    void update_force_control(const Action& action)
    {
        if (action.event != Event::none) force_control_.begin_pass(path_.passes()[action.to.pass].along);
        if (action.kind != Action::Kind::grind) return force_control_.interrupt_stroke();
        force_control_.record(action.to.point, remaining(machine_.status()), impulse_);
    }

    /// Height of the stock above the reference surface.
    double remaining(const gantry::GantryStatus& status) const
    {
        return status.deflection + height_error_ - force_offset_;
    }

    /// Commanded tool point in this layer.
    Eigen::Vector3d tool_point(int layer) const
    {
        const double offset = plan::reference_offset(plan_.layers, layer) - wheel_wear_ - force_offset_;
        return reference_point_ + offset * Eigen::Vector3d::UnitZ();
    }

    void travel(const Action& action, const Eigen::Vector3d& reference)
    {
        force_offset_ = 0;
        reference_point_ = reference;
        resume_from_trace(action);
        record_move(machine_.travel(mark(action, event_), tool_point(action.layer)), action.layer, 0);
    }

    void grind(const Action& action, const Eigen::Vector3d& reference)
    {
        if (action.layer == 1 && options_.layer_1 == Layer1::feed) return grind_controlled(action, reference);
        reference_point_ = reference;
        grind_at(action, plan_.job.feed.rate);
    }

    /// Grinds to the tool point of reference_point_.
    void grind_at(const Action& action, double feed)
    {
        resume_from_trace(action);
        record_move(machine_.grind(mark(action, event_), tool_point(action.layer), feed), action.layer, feed);
        event_ = Event::none;
    }

    /// Grinds in layer 1 with the feed-rate control, period by period.
    void grind_controlled(const Action& action, const Eigen::Vector3d& reference)
    {
        const Eigen::Vector3d from = reference_point_, motion = reference - from;
        const double length = motion.norm();
        for (double travelled = 0; travelled < length && machine_.status().force <= plan_.job.force.max;) {
            travelled = std::min(travelled + feed_control_.feed() * feed_control_.period(), length);
            reference_point_ = from + motion * (travelled / length);
            const gantry::GantryStatus before = machine_.status();
            grind_at(action, feed_control_.feed());
            const gantry::GantryStatus& after = machine_.status();
            feed_control_.update(before.deflection, after.deflection, after.time - before.time);
        }
    }

    /// Crosses to the next pass in pieces of a step, along the surface between the two. Ends early if the wheel climbs
    /// on something that is too high: the strategy goes up a layer at this position, and then on.
    void cross(const Action& action)
    {
        const Eigen::Vector3d a = reference_point_, b = reference(action.to);
        const int pieces = std::max(1, int(std::ceil((b - a).head<2>().norm() / plan_.step)));
        force_offset_ = 0;
        force_control_.begin_pass(path_.passes()[action.to.pass].along);
        // The path is a parabola through the tool point half-way: a straight line would cut into a convex surface.
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

    /// Records the end of a move. A guarded descent may have stopped above the reference surface; a grinding step has
    /// not, though a machine with look-ahead may not have reached its end yet.
    void record_move(const gantry::GantryStatus& status, int layer, double feed)
    {
        height_error_ = feed > 0 ? 0 : std::max(0.0, status.commanded.z() - tool_point(layer).z());
        result_.peak_force = std::max({result_.peak_force, status.force, status.peak_force});
        const double duration = feed > 0 ? status.time - last_time_ : 0; // of grinding
        impulse_ = (last_force_ + status.force) / 2 * duration;
        grinding_time_ += duration;
        wear_model_.add_force(status.force, duration);
        if (single_covering()) wheel_wear_ = wear_model_.loss();
        last_time_ = status.time;
        last_force_ = status.force;
        if (contact_watch_ && machine_.is_live()) contact_watch_->follow(status, feed);
    }

    /// At the end of an interrupted run's trace, the machine's position and wheel are unknown: measures the wheel and
    /// goes back to the last position.
    void resume_from_trace(const Action& action)
    {
        if (!machine_.replay_ended() && !machine_.was_resumed_here()) return;
        const Eigen::Vector3d position = machine_.status().commanded;
        if (machine_.replay_ended()) machine_.go_live();
        measure_wheel(action);
        if (action.kind != Action::Kind::travel) machine_.travel(mark(action, Event::none), position);
        last_time_ = machine_.status().time;
    }

    void measure_wheel_if_due(const Action& action)
    {
        const bool covering = action.event == Event::start || action.event == Event::covering_done;
        const bool in_pass = action.kind == Action::Kind::grind && action.event == Event::none;
        const bool due = grinding_time_ - last_touch_off_ >= options_.touch_off_period ||
                         (single_covering() && action.layer == 1 && wear_model_.measurement_due());
        if (!covering && !(due && (in_pass || action.kind == Action::Kind::travel))) return;
        measure_wheel(action);
        if (!in_pass) return;
        event_ = Event::none;
        travel({Action::Kind::travel, Event::none, at_, action.layer}, reference(at_));
    }

    void measure_wheel(const Action& action)
    {
        const double min_radius = plan_.job.wheel.min_radius;
        double radius = touch_off(action);
        if (radius < min_radius) {
            machine_.change_wheel(mark(action, Event::wheel_change));
            wear_model_.start_new_wheel();
            ++result_.wheel_changes;
            radius = touch_off(action);
            if (radius < min_radius)
                throw core::InputError(plan_.job.source, "wheel.min_radius: a new wheel measures " +
                                                             core::to_short_text(radius / plan_.job.units.mm()));
        }
        if (radius != result_.wheel_radius) path_.set_radius(radius);
        result_.wheel_radius = radius;
        last_touch_off_ = grinding_time_;
    }

    double touch_off(const Action& action)
    {
        const double radius = machine_.touch_off(mark(action, Event::touch_off));
        ++result_.touch_offs;
        wear_model_.set_measured_radius(radius);
        wheel_wear_ = 0;
        last_time_ = machine_.status().time;
        return radius;
    }

    const plan::Plan& plan_;
    RunOptions options_;
    Recorder machine_;
    plan::ToolPath path_;
    LayerSwitching::Settings settings_;
    LayerSwitching strategy_;
    FeedControl feed_control_;
    ForceControl force_control_;
    WheelWear wear_model_;
    std::optional<ContactWatch> contact_watch_;
    GrindRun result_;
    PathIndex at_;
    Eigen::Vector3d reference_point_ = Eigen::Vector3d::Zero(); ///< tool point in layer 1 at the tool's position
    double wheel_wear_ = 0;     ///< estimated since the last measurement, mm; only if one covering has to suffice
    double force_offset_ = 0;   ///< how far the drives go below the reference to reach the desired force, mm
    double impulse_ = 0;        ///< ∫F dt of the last step, N s
    Event event_ = Event::none; ///< of the next row
    double height_error_ = 0;   ///< how far the drives are above their target, mm
    double grinding_time_ = 0, last_touch_off_ = 0; ///< s, and its value at the last touch-off
    double last_time_ = 0, last_force_ = 0;         ///< of the machine at the end of the last move
};

} // namespace

GrindRun run(const plan::Plan& plan, gantry::Gantry& gantry, const RunOptions& options, const core::Progress& progress)
{
    return Runner(plan, gantry, options).run(progress);
}

} // namespace fettle::strategy
