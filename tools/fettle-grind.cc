#include "align/rigid.h"
#include "calibrate/run_learning.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "gantry/loops.h"
#include "job/frame.h"
#include "plan/plan.h"
#include "strategy/run.h"
#include "strategy/run_identity.h"
#include "strategy/run_json.h"
#include "strategy/stock_frames.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"

#include <chrono>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

using namespace fettle;

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
    cli::Tool& t;
    const std::string& plan = t.main_input("PLAN", "What to do, JSON (fettle-plan)");
    gantry::StockOptions stock{t};
    gantry::GantryOptions gantry{
        t,
        {.fallback = "virtual",
         .gantry = "The machine: a simulated gantry that is always in equilibrium (virtual), one with drives, inertia "
                   "and sensors (virtual:dynamic), or a driver (docs/driver.md)"}};
    const std::string& place =
        t.optional_file("--place", "FILE",
                        "A robot's driver: where the part lies in its cell, a 4 x 4 matrix as fettle-place takes it, "
                        "lengths in the job's unit");
    const strategy::Layer1& layer_1 = t.choice<strategy::Layer1>(
        "--layer-1",
        {{"constant", strategy::Layer1::constant},
         {"feed", strategy::Layer1::feed},
         {"force", strategy::Layer1::force}},
        "Layer 1 at the job's feed, up to twice as fast where nothing is known to stand, covering after covering; or "
        "pass after pass, with controlled feed or controlled force");
    const double& removal_factor = gantry::declare_removal_factor(t);
    const std::string& trace =
        t.optional_output("--trace", "What the machine did and why, PCD, written ahead", {"pcd"});
    const std::string& resume =
        t.text("--resume", "", "TRACE", "Continue the interrupted run that wrote this trace, and append to it");
    const std::string& learn =
        t.text("--learn", "", "LAW", "Removal law, learnt from run to run: read if it is there, and written anew");
    const cloud::CloudOutput out{t};
    draw::Frames frames{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan jobs/wang1.json | "
              "fettle-grind --stock <(fettle-part parts/wang1.json) --gantry virtual:dynamic "
              "--machine machines/full_scale.json --trace trace.pcd > ground.pcd",
              "Wang's part 1 from the job to the ground part, on a machine with inertia");
    t.reference("Wang 2007, 5.3.2 and figure 5-7: the layer-based path planning strategy; 6.1.2, eq. 6-1 to 6-8: "
                "the machine");
}

/// Where the job lies in the cell of a robot, mm; nothing: the machine has a frame of its own.
std::optional<Eigen::Isometry3d> place_of(const Options& o, const job::Job& job)
{
    if (o.place.empty()) return std::nullopt;
    if (!o.gantry.has_driver()) throw core::InputError("--place", "goes with --gantry exec:COMMAND, a robot's driver");
    Eigen::Isometry3d T_cell_part(align::read_transform(o.place));
    T_cell_part.translation() *= job.units.mm();
    return T_cell_part * job.T_part_job.value_or(Eigen::Isometry3d::Identity());
}

strategy::RunOptions run_options(const Options& o, const units::Units& units, const strategy::RunIdentity& identity,
                                 const std::optional<strategy::KnownRemoval>& known)
{
    strategy::RunOptions options;
    options.layer_1 = o.layer_1;
    options.known_removal = known;
    options.previous_source = o.resume;
    if (o.resume.empty()) return options;
    strategy::RecordedTrace trace = strategy::read_recorded_trace(o.resume, units);
    strategy::require_same_run(trace, identity, core::display_name(o.resume));
    if (!trace.cut.empty()) o.t.warn(core::display_name(o.resume) + ": " + trace.cut);
    options.previous_trace = std::move(trace.rows);
    return options;
}

/// Writes the trace of the run that has ended. A journal that could not hold it keeps the rows for which there was
/// room; one that holds it, but has no room for a second copy, stays as it is.
void save_trace(const Options& o, const std::vector<strategy::TraceRow>& trace, const strategy::TraceFile* journal,
                const units::Units& units, const strategy::RunIdentity& identity)
{
    const cloud::PcdEncoding encoding = cloud::pcd_encoding(o.out.ascii);
    if (journal == nullptr) {
        if (!o.trace.empty()) strategy::write_trace(o.t.output_file(o.trace), trace, units, encoding, identity);
        return;
    }
    if (journal->has_failed()) return;
    try {
        core::OutputFile file(o.trace.empty() ? o.resume : o.trace);
        strategy::write_trace(file.stream(), trace, units, encoding, identity);
        file.commit();
    } catch (const core::InputError& error) {
        o.t.warn(error.what() + std::string("; the trace stays as it was written ahead"));
    }
}

/// The plan with the removal coefficient that was learnt in former runs.
plan::Plan informed(const plan::Plan& plan, const std::optional<calibrate::RunLearning>& learning)
{
    plan::Plan result = plan;
    if (learning) result.job = learning->informed(plan.job);
    return result;
}

/// Learns from the run, warns of strokes that the law does not explain, and hands the law on.
void learn_from(const Options& o, const strategy::GrindRun& run, const job::Job& job, const removal::HeightField& stock,
                calibrate::RunLearning& learning)
{
    learning.learn_from(run.trace, job, stock);
    for (const std::string& line : learning.warnings()) o.t.warn(core::display_name(o.plan) + ": " + line);
    o.t.report().set("learnt", learning.report());
    if (learning.is_informed()) o.t.output_file(o.learn) << learning.file();
}

/// Machine time beside the time that computing took.
void note_times(const cli::Tool& t, double time, Clock::time_point begun)
{
    const double computing = std::chrono::duration<double>(Clock::now() - begun).count();
    t.note("machine time " + std::to_string(time) + " s, computing time " + std::to_string(computing) + " s, ratio " +
           std::to_string(time / computing));
}

/// What the simulated machine did in all, and how its controllers were tuned: in the report, the latter also on stderr
/// with -v.
void report_simulation(const Options& o, const gantry::VirtualGantry& simulated, const job::Job& job)
{
    gantry::add_report(o.t.report(), simulated.totals());
    if (o.gantry.machine.empty()) return;
    std::vector<json::Value> list;
    for (const gantry::ControlLoop& loop : gantry::tune_loops(gantry::read_machine(o.gantry.machine), job)) {
        o.t.note(to_string(loop));
        list.push_back(to_json(loop));
    }
    o.t.report().set("loops", list);
}

/// Says where the force went over its limit, and why a run did not finish.
void say_outcome(const Options& o, const strategy::GrindRun& run, const job::Job& job)
{
    const std::string prefix = core::display_name(o.plan) + ": ";
    if (const std::string doubt = strategy::peak_warning(run.force, job); !doubt.empty()) o.t.warn(prefix + doubt);
    if (run.faulted)
        o.t.fault(prefix + run.failure);
    else if (!run.finished)
        o.t.warn(prefix + run.failure);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Grind a part to its desired surface, guided by the force.", [](cli::Tool& t) {
        Options o{t};
        add_usage(t);
        t.parse();
        o.gantry.check();
        o.frames.check_folder();

        const auto begun = Clock::now();
        std::optional<calibrate::RunLearning> learning;
        if (!o.learn.empty()) {
            learning.emplace(o.learn);
            core::OutputFile{o.learn}; // where it cannot be written, that is said before the part is ground
        }
        const plan::Plan given = plan::read_plan(o.plan), plan = informed(given, learning);
        const auto known = learning ? learning->known() : std::nullopt;
        const units::Units& units = plan.job.units;
        const auto T_cell_job = place_of(o, plan.job);
        const auto [stock, doubts, dropped] = gantry::read_stock(o.stock, plan.job, removal::Extent::anomaly);
        gantry::require_below_safe_height(stock, plan.job, core::display_name(o.stock.file));
        for (const std::string& doubt : doubts) t.warn(doubt);
        const std::string& trace_file = o.trace.empty() ? o.resume : o.trace;
        if (o.trace.empty() && !o.resume.empty()) t.reserve_output(o.resume);
        const auto identity = trace_file.empty() ? strategy::RunIdentity{}
                                                 : strategy::identity_of(plan, stock, o.layer_1, known, T_cell_job);
        strategy::RunOptions options = run_options(o, units, identity, known);
        const cloud::PcdEncoding encoding = cloud::pcd_encoding(o.out.ascii);
        const auto journal = strategy::open_journal(trace_file, units, encoding, options.previous_trace, identity);
        options.journal = journal.get();

        const removal::HeightField left = strategy::replay_removal(options.previous_trace, plan.job, stock);
        auto [machine, limits, simulated] =
            gantry::open_gantry(o.gantry, given.job, left, t.seed(), o.removal_factor, T_cell_job);
        if (simulated == nullptr) options.known_stock = &left;
        const strategy::GrindRun run = strategy::run(plan, *machine, options, t.progress("grinding"));
        if (simulated == nullptr) machine.reset(); // it lifts now, not after what is computed below
        const removal::HeightField ground =
            simulated ? simulated->stock() : strategy::replay_removal(run.trace, plan.job, stock);

        o.out.write(job::in_job_frame(removal::to_cloud(stock, ground), plan.job), units);
        if (o.frames.wanted()) {
            strategy::add_frames(o.frames, run.trace, plan, stock);
            o.frames.finish("The stock's height over the desired surface while it is ground.");
        }
        save_trace(o, run.trace, journal.get(), units, identity);
        t.report() = strategy::to_json(run, removal::volume_between(stock, ground), o.out.units(units));
        t.report().set("dropped_facets", dropped);
        if (simulated) report_simulation(o, *simulated, plan.job);
        if (learning) learn_from(o, run, plan.job, stock, *learning);
        note_times(t, run.trace.back().time, begun);
        say_outcome(o, run, plan.job);
        return run.finished ? cli::Verdict::yes : cli::Verdict::no;
    });
}
