// The part of MachineWork that grinds: by itself, or led by the operator.

#include "core/error.h"
#include "core/file.h"
#include "job/frame.h"
#include "station/checkpoint.h"
#include "station/machine_work.h"
#include "strategy/run_identity.h"
#include "strategy/trace_file.h"

#include <limits>
#include <ostream>
#include <utility>

namespace fettle::station {
void MachineWork::grind(const Save& save)
{
    teacher_.reset();
    const removal::HeightField& stock = place_.stock(plan_->job);
    add_warnings(place_.warnings);
    const strategy::RunIdentity identity =
        strategy::identity_of(*plan_, stock, options_.layer_1, std::nullopt, std::nullopt);
    std::vector<strategy::TraceRow> previous;
    if (folder_.has(kTraceFile)) {
        strategy::RecordedTrace trace = read_trace_or_checkpoint(folder_.file(kTraceFile), plan_->job.units);
        strategy::require_same_run(trace, identity, kTraceFile);
        previous = std::move(trace.rows);
    }
    place_.open_to_grind(plan_->job, traces());
    const strategy::GrindRun run = run_plan(save, std::move(previous), identity);
    live_.layer = live_.pass = 0;
    if (run.stopped) add_stop(run.trace, asked_ + run.trace.back().time - gantry().status().time);
    session_.ground(run);
    if (!run.finished && !run.stopped) give_up(run.failure);
    save_ground();
    clock_.steering.discard();
}

strategy::GrindRun MachineWork::run_plan(const Save& save, std::vector<strategy::TraceRow> previous,
                                         const strategy::RunIdentity& identity)
{
    const job::Job& job = plan_->job;
    strategy::RunOptions options;
    options.layer_1 = options_.layer_1;
    options.previous_trace = std::move(previous);
    options.previous_source = kTraceFile;
    const auto journal = strategy::open_journal(folder_.file(kTraceFile), job.units, options_.encoding,
                                                options.previous_trace, identity);
    options.journal = journal.get();
    std::optional<Checkpoint> checkpoint(folder_.file(kTraceFile));
    removal::HeightField known;
    if (!place_.is_simulated()) known = place_.ground(job, traces());
    if (known.z.size() > 0) options.known_stock = &known;
    Forecast forecast(*plan_);
    options.watch = [&](const strategy::TraceRow& row) {
        forecast.follow(row);
        live_.layer = row.layer;
        live_.pass = row.pass;
        live_.time_left = forecast.time_left();
        checkpoint->follow(*journal);
    };
    session_.begin(Stage::grind);
    save();
    arm(true);
    strategy::GrindRun run = strategy::run(*plan_, gantry(), options);
    checkpoint.reset();
    if (!journal->has_failed()) save_trace(kTraceFile, run.trace, identity);
    if (const std::string doubt = strategy::peak_warning(run.force, plan_->job); !doubt.empty()) add_warnings({doubt});
    return run;
}

/// A trace that is whole and on the disk needs no checkpoint.
void MachineWork::save_trace(const std::string& name, const std::vector<strategy::TraceRow>& trace,
                             const strategy::RunIdentity& identity) const
{
    folder_.save(name, [&](std::ostream& out) {
        strategy::write_trace(out, trace, plan_->job.units, options_.encoding, identity);
    });
    folder_.remove(checkpoint_of(name));
}

/// Ended by space, n, or the end of the session.
void MachineWork::steer(const Save& save)
{
    if (!place_.can_press())
        throw core::InputError("manual mode needs a machine that can hold a force: virtual:dynamic, or a driver's");
    teacher_.reset();
    const job::Job& job = plan_->job;
    gantry::OpenGantry& machine = place_.open_to_grind(job, traces());
    session_.begin(Stage::manual);
    save();
    const std::string file = manual_file(session_.record().manual_runs);
    const auto journal = strategy::open_journal(folder_.file(file), job.units, options_.encoding);
    strategy::ManualOptions options;
    options.force = options_.force.value_or(job.force.down);
    options.lowest = options_.lowest.value_or(machine.limits.min.z());
    options.journal = journal.get();
    options.steering_time = clock_.time;
    std::optional<Checkpoint> checkpoint(folder_.file(file));
    options.go_on = [&](const strategy::Stick& stick, const gantry::GantryStatus& now) {
        live_.machine = now;
        checkpoint->follow(*journal);
        keep_pace(now.time);
        show(false);
        return stick.button != strategy::Button::stop && stick.button != strategy::Button::next && !is_terminated();
    };
    arm(false);
    const strategy::ManualRun run = strategy::run_manual(job, gantry(), clock_.steering, options);
    clock_.time = run.steering_time;
    checkpoint.reset();
    if (!journal->has_failed()) save_trace(file, run.trace, {});
    if (!run.trace.empty() && run.trace.back().event == strategy::Event::stopped) add_stop(run.trace, asked_);
    if (!run.failure.empty()) give_up(run.failure);
    session_.steered(run);
    save_ground();
    clock_.steering.discard();
}

/// The last two rows of a trace that the operator has stopped: the wheel is off the part, and at the safe height.
void MachineWork::add_stop(const std::vector<strategy::TraceRow>& trace, double asked)
{
    session_.add_stop({asked, trace.end()[-2].time, trace.back().time});
}

std::string MachineWork::manual_file(int run) const { return "manual-" + std::to_string(run) + ".pcd"; }

std::vector<strategy::TraceRow> MachineWork::read_trace(const std::string& name)
{
    if (!folder_.has(name)) return {};
    strategy::RecordedTrace trace = read_trace_or_checkpoint(folder_.file(name), session_.record().job.units);
    if (!trace.cut.empty()) add_warnings({name + ": " + trace.cut});
    return std::move(trace.rows);
}

MachineWork::Traces MachineWork::traces()
{
    Traces all = {read_trace(kTraceFile)};
    for (int run = 1; run <= session_.record().manual_runs; ++run) all.push_back(read_trace(manual_file(run)));
    return all;
}

void MachineWork::save_ground()
{
    const job::Job& job = plan_->job;
    const removal::HeightField& stock = place_.stock(job);
    if (stock.z.size() == 0) return;
    const removal::HeightField ground = place_.ground(job, traces());
    folder_.save(kGroundFile, [&](std::ostream& out) {
        cloud::write_pcd(out, job::in_job_frame(removal::to_cloud(stock, ground), job), job.units, options_.encoding);
    });
}

} // namespace fettle::station
