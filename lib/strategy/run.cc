#include "strategy/run.h"

#include "core/error.h"
#include "core/text.h"
#include "strategy/runner.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fettle::strategy {
namespace {

constexpr int kStepsPerProgress = 256;

/// z, mm
double highest_point(const plan::ToolPath& path)
{
    double highest = -std::numeric_limits<double>::infinity();
    for (const plan::ToolPass& pass : path.passes())
        for (const Eigen::Vector3d& point : pass.points) highest = std::max(highest, point.z());
    return highest;
}

} // namespace

Runner::Runner(const plan::Plan& plan, gantry::Gantry& gantry, const RunOptions& options)
    : plan_(plan), options_(options),
      machine_(gantry, plan.job.units, options.previous_trace, options.previous_source, options.journal),
      path_(plan.job, plan.surface, plan.passes, plan.step),
      wear_model_(plan.job, strategy_settings(plan).max_remaining, options.known_removal), settings_(settings(plan)),
      strategy_(path_.passes(), settings_, {force_on_passes(StockBound::kMaxHardness), force_on_passes(1)}),
      feed_control_(plan.job, settings_.max_remaining),
      force_control_(plan.job, settings_.max_remaining, options.known_removal), bound_(plan.job, highest_point(path_))
{
    if (options.known_stock != nullptr) contact_watch_.emplace(*options.known_stock, plan.job);
}

/// A known wear tells what is left on a pass when it is ground. Without it nobody knows that until the wheel is
/// measured, at the end of a covering.
LayerSwitching::Settings Runner::settings(const plan::Plan& plan) const
{
    LayerSwitching::Settings settings = strategy_settings(plan);
    settings.finish_passes = single_covering();
    settings.skip_finished_passes = wear_model_.is_known();
    return settings;
}

GrindRun Runner::run(const core::Progress& progress)
{
    Action action = strategy_.first();
    try {
        grind_until_done(action, progress);
        machine_.record_decision(mark(action, action.event));
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

void Runner::fail(const Action& action, const gantry::GantryFault& fault)
{
    machine_.record_fault(mark(action, Event::fault));
    result_.failure = fault.what();
    result_.faulted = true;
}

void Runner::retract(const Action& action)
{
    try {
        machine_.retract(mark(action, Event::stopped), plan_.job.safe_height);
        result_.stopped = true;
    } catch (const gantry::GantryFault& fault) {
        fail(action, fault);
    }
}

/// @param action  the last one when the strategy is done, or the machine has stopped
void Runner::grind_until_done(Action& action, const core::Progress& progress)
{
    while (action.kind != Action::Kind::finish && action.kind != Action::Kind::fail) {
        measure_wheel_if_due(action);
        perform(action);
        if (options_.watch) options_.watch(machine_.trace().back());
        if (strategy_.counts().steps % kStepsPerProgress == 0)
            core::report_progress(progress, double(action.to.pass) / double(path_.passes().size()));
        const gantry::GantryStatus& status = machine_.status();
        action = strategy_.next({decisive_force(), remaining(status), status.time});
    }
}

void Runner::perform(const Action& action)
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
        machine_.record_decision(mark(action, event_));
        break;
    }
    if (by_force(action.layer)) update_force_control(action);
}

void Runner::update_force_control(const Action& action)
{
    if (action.event != Event::none) force_control_.begin_pass(path_.passes()[action.to.pass].along);
    if (action.kind != Action::Kind::grind) return force_control_.interrupt_stroke();
    force_control_.record(action.to.point, remaining(machine_.status()), impulse_);
}

/// At the end of an interrupted run's trace, the machine's position and wheel are unknown: measures the wheel and
/// goes back to the last position.
void Runner::resume_from_trace(const Action& action)
{
    if (!machine_.replay_ended() && !machine_.was_resumed_here()) return;
    const Eigen::Vector3d position = machine_.status().commanded;
    if (machine_.replay_ended()) machine_.go_live();
    measure_wheel(action);
    if (action.kind != Action::Kind::travel) machine_.travel(mark(action, Event::none), position);
    last_time_ = machine_.status().time;
}

void Runner::measure_wheel_if_due(const Action& action)
{
    const bool covering =
        action.event == Event::start || (action.event == Event::covering_done && !wear_model_.is_known());
    const bool in_pass = action.kind == Action::Kind::grind && action.event == Event::none;
    // A known wear is measured again where its error may matter, however long that takes.
    const bool due = wear_model_.is_known()
                         ? wear_model_.measurement_due()
                         : grinding_time_ - last_touch_off_ >= options_.touch_off_period ||
                               (compensates_wear() && finishing(action.layer) && wear_model_.measurement_due());
    if (!covering && !(due && (in_pass || action.kind == Action::Kind::travel))) return;
    measure_wheel(action);
    if (!in_pass) return;
    event_ = Event::none;
    travel({Action::Kind::travel, Event::none, at_, action.layer}, reference(at_));
}

void Runner::measure_wheel(const Action& action)
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

double Runner::touch_off(const Action& action)
{
    const double radius = machine_.touch_off(mark(action, Event::touch_off));
    ++result_.touch_offs;
    wear_model_.set_measured_radius(radius);
    wheel_wear_ = 0;
    last_time_ = machine_.status().time;
    return radius;
}

GrindRun run(const plan::Plan& plan, gantry::Gantry& gantry, const RunOptions& options, const core::Progress& progress)
{
    return Runner(plan, gantry, options).run(progress);
}

} // namespace fettle::strategy
