#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "core/text.h"
#include "gantry/driver.h"
#include "gantry/loops.h"
#include "gantry/make_virtual.h"
#include "job/plausible.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "sampling/scan.h"
#include "strategy/run.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"
#include "json/units.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <ostream>

using namespace fettle;

namespace {

using Clock = std::chrono::steady_clock;

// What --gantry says: a driver's command line, or a simulated machine, with drives or without.
const std::string kDriver = "exec:", kVirtual = "virtual", kDynamic = "virtual:dynamic";

void check_gantry(const std::string& gantry, const std::string& machine)
{
    if (gantry != kVirtual && gantry != kDynamic && (gantry.rfind(kDriver, 0) != 0 || gantry == kDriver))
        throw InputError("--gantry: '" + gantry + "' is none of virtual, virtual:dynamic, exec:COMMAND");
    if ((gantry == kDynamic) == machine.empty())
        throw InputError("--machine", "goes with --gantry virtual:dynamic, and that with it");
}

void report_run(json::Value& out, const GrindRun& run, double machine_time, const Units& units)
{
    out.set("kind", "grinding")
        .set("units", json::to_json(units))
        .set("finished", run.finished)
        .set("machine_time", machine_time)
        .set("layers", run.counts.highest_layer)
        .set("coverings", run.counts.coverings)
        .set("strokes", run.counts.strokes)
        .set("re_cuts", run.counts.re_cuts)
        .set("raises", run.counts.raises)
        .set("passes", run.counts.passes)
        .set("steps", run.counts.steps)
        .set("peak_force", run.peak_force / units.newton())
        .set("touch_offs", run.touch_offs)
        .set("wheel_changes", run.wheel_changes)
        .set("wheel_radius", run.wheel_radius / units.mm());
}

void report_totals(json::Value& out, const GrindTotals& totals)
{
    out.set("grinding_time", totals.grinding_time)
        .set("travel_time", totals.travel_time)
        .set("service_time", totals.service_time);
}

// The trace of a run is written ahead to a file that its name leads to; there is nothing to be resumed from a pipe.
std::unique_ptr<TraceFile> journal_at(const std::string& path, const Units& units, PcdEncoding encoding,
                                      const std::vector<TraceRow>& done)
{
    namespace fs = std::filesystem;
    if (path.empty() || path == "-" || (fs::exists(path) && !fs::is_regular_file(path))) return nullptr;
    return std::make_unique<TraceFile>(path, units, encoding, done);
}

// How the machine's controllers were tuned: on stderr with -v, and in the report.
void tell_loops(Tool& t, const std::vector<Loop>& loops)
{
    std::vector<json::Value> list;
    for (const Loop& loop : loops) {
        const double phase = loop.margins.phase * 180 / std::numbers::pi;
        t.note("loop " + loop.name + ": bandwidth " + to_short_text(loop.bandwidth) + " rad/s, gain margin " +
               to_short_text(loop.margins.gain) + ", phase margin " + to_short_text(phase) + "\u00B0");
        list.push_back(json::Value()
                           .set("loop", loop.name)
                           .set("bandwidth", loop.bandwidth)
                           .set("gain_margin", loop.margins.gain)
                           .set("phase_margin_deg", phase));
    }
    t.report().set("loops", list);
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Grind a part to its desired surface, guided by the force.", [](Tool& t) {
        const std::string& plan_file = t.input("PLAN", "What to do, JSON (fettle-plan)");
        const std::string& stock_file = t.required_file("--stock", "PART", "The part as it is: STL, PLY, OBJ or PCD");
        const auto& stock_units = t.length_unit("--stock-units", "Unit of PART, if it is not the job's");
        const std::string& kind = t.text("--gantry", kVirtual, "virtual|virtual:dynamic|exec:COMMAND",
                                         "The machine: a simulated gantry in equilibrium at every moment, one with "
                                         "drives, inertia and sensors, or a driver (docs/driver.md)");
        const std::string& machine = t.other_file("--machine", "FILE", "The machine of virtual:dynamic, JSON");
        const double& patience = t.number("--patience", 10, "SECONDS",
                                          "A driver may answer so much later than the move takes", Range::positive());
        const std::string& layer_1 =
            t.choice("--layer-1", "constant", {"constant", "feed", "force"},
                     "Layer 1 at the job's feed, covering after covering; or pass after pass, with controlled feed or "
                     "controlled force");
        const double& removal =
            t.number("--removal-factor", 1, "FACTOR", "The virtual stock yields so many times as fast as the job says",
                     Range::positive());
        const auto& cell = t.number_if_given(
            "--cell", "LENGTH", "Side of a cell of the stock; default: 1/64 of the wheel's width", Range::positive());
        const std::string& trace = t.other_output("--trace", "What the machine did and why, PCD, written ahead");
        const std::string& resume =
            t.text("--resume", "", "TRACE", "Go on where the run that wrote this trace was cut off, and add to it");
        const bool& ascii = t.flag("--ascii", "Write PCDs as text");
        t.example("fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan jobs/wang1.json | "
                  "fettle-grind --stock <(fettle-part parts/wang1.json) --gantry virtual:dynamic "
                  "--machine machines/full_scale.json --trace trace.pcd > ground.pcd",
                  "Wang's part 1 from the job to the ground part, on a machine with inertia");
        t.reference("Wang 2007, 5.3.2 and figure 5-7: the layer-based path planning strategy; 6.1.2, eq. 6-1 to 6-8: "
                    "the machine");
        t.parse();
        check_gantry(kind, machine);

        const auto begun = Clock::now();
        const Plan plan = read_plan(plan_file);
        const Units& units = plan.job.units;
        const Scan scan = read_scan(stock_file, units, stock_units);
        if (const std::string doubt = implausible_box(scan.bounds(), plan.job); !doubt.empty())
            t.warn(display_name(stock_file) + ": " + doubt);
        const HeightField stock =
            height_field(scan, plan.job, cell_of(plan.job, cell ? *cell * units.mm() : 0), display_name(stock_file));
        RunOptions options;
        options.layer_1 = layer_1 == "feed" ? Layer1::feed : layer_1 == "force" ? Layer1::force : Layer1::constant;
        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        if (!resume.empty()) options.done = read_trace(resume, units);
        options.done_source = resume;
        const std::string& trace_file = trace.empty() ? resume : trace;
        std::ostream* trace_out = trace_file.empty() ? nullptr : &t.output_file(trace_file);
        const std::unique_ptr<TraceFile> journal = journal_at(trace_file, units, encoding, options.done);
        options.journal = journal.get();
        const HeightField left = ground_by(options.done, plan.job, stock);

        std::unique_ptr<VirtualGantry> simulated;
        std::unique_ptr<DriverGantry> driver;
        if (kind.rfind(kDriver, 0) == 0)
            driver = std::make_unique<DriverGantry>(kind.substr(kDriver.size()), plan.job, patience);
        else
            simulated = make_virtual(left, plan.job, {machine, removal, t.seed()});
        Gantry& gantry = driver ? static_cast<Gantry&>(*driver) : *simulated;
        const GrindRun run = fettle::run(plan, gantry, options, t.progress("grinding"));
        const HeightField ground = simulated ? simulated->stock() : ground_by(run.trace, plan.job, stock);

        write_pcd(t.output(), to_cloud(stock, ground), units, encoding);
        if (trace_out != nullptr) write_pcd(*trace_out, to_cloud(run.trace), units, encoding);
        const double time = run.trace.back().time;
        report_run(t.report(), run, time, units);
        t.report().set("removed_volume", volume_between(stock, ground) / std::pow(units.mm(), 3));
        if (simulated) report_totals(t.report(), simulated->totals());
        if (!machine.empty()) tell_loops(t, loops_of(read_machine(machine), plan.job));
        const double computing = std::chrono::duration<double>(Clock::now() - begun).count();
        t.note("machine time " + std::to_string(time) + " s, computing time " + std::to_string(computing) +
               " s, ratio " + std::to_string(time / computing));
        if (!run.finished) t.warn(display_name(plan_file) + ": " + run.failure);
        return run.finished ? Verdict::yes : Verdict::no;
    });
}
