#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "gantry/dynamic.h"
#include "gantry/quasi_static.h"
#include "job/plausible.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "sampling/scan.h"
#include "strategy/run.h"

#include <chrono>
#include <memory>
#include <ostream>

using namespace fettle;

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kCellsPerWidth = 64; // of the wheel: 0.1 mm for one of 1/4 in

Cloud to_cloud(const std::vector<TraceRow>& trace)
{
    const Eigen::Index n = Eigen::Index(trace.size());
    Cloud cloud;
    cloud.xyz.resize(3, n);
    Eigen::MatrixXd rows(n, 6);
    for (Eigen::Index i = 0; i < n; ++i) {
        const TraceRow& row = trace[std::size_t(i)];
        cloud.xyz.col(i) = row.tool;
        rows.row(i) << row.time, row.layer, row.pass, int(row.event), row.force, row.feed;
    }
    set_field(cloud, "t", rows.col(0), 8); // a float resolves a day's run to 8 ms only
    const char* names[] = {"layer", "pass", "event", "force", "feed"};
    for (int k = 0; k < 5; ++k) set_field(cloud, names[k], rows.col(k + 1));
    return cloud;
}

void report(json::Value& out, const GrindRun& run, const VirtualGantry& gantry, const Units& units)
{
    const double mm = units.mm();
    const GrindTotals& totals = gantry.totals();
    json::Value unit;
    unit.set("length", to_string(units.length)).set("force", to_string(units.force));
    out.set("kind", "grinding")
        .set("units", unit)
        .set("finished", run.finished)
        .set("removed_volume", totals.removed_volume / (mm * mm * mm))
        .set("machine_time", gantry.status().time)
        .set("grinding_time", totals.grinding_time)
        .set("travel_time", totals.travel_time)
        .set("service_time", totals.service_time)
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
        .set("wheel_radius", run.wheel_radius / mm);
}

std::unique_ptr<VirtualGantry> make_gantry(const std::string& machine_file, const HeightField& stock, const Job& job,
                                           double removal_factor, std::uint64_t seed)
{
    if (machine_file.empty()) {
        QuasiStaticOptions options;
        options.removal_factor = removal_factor;
        return std::make_unique<QuasiStaticGantry>(stock, job, options);
    }
    DynamicOptions options;
    options.removal_factor = removal_factor;
    options.seed = seed;
    return std::make_unique<DynamicGantry>(stock, job, read_machine(machine_file), options);
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Grind a part to its desired surface, guided by the force.", [](Tool& t) {
        const std::string& plan_file = t.input("PLAN", "What to do, JSON (fettle-plan)");
        const std::string& stock_file = t.required_text("--stock", "PART", "The part as it is: STL, PLY, OBJ or PCD");
        const auto& stock_units = t.length_unit("--stock-units", "Unit of PART, if it is not the job's");
        const std::string& kind =
            t.choice("--gantry", "virtual", {"virtual", "virtual:dynamic"},
                     "The machine: a simulated gantry in equilibrium at every moment, or one with "
                     "drives, inertia and sensors");
        const std::string& machine = t.text("--machine", "", "FILE", "The machine of virtual:dynamic, JSON");
        const std::string& layer_1 =
            t.choice("--layer-1", "constant", {"constant", "feed"},
                     "Layer 1 at the job's feed, covering after covering; or with controlled feed, pass after pass");
        const double& removal =
            t.number("--removal-factor", 1, "FACTOR", "The virtual stock yields so many times as fast as the job says",
                     Range::positive());
        const auto& cell = t.number_if_given(
            "--cell", "LENGTH", "Side of a cell of the stock; default: 1/64 of the wheel's width", Range::positive());
        const std::string& trace = t.text("--trace", "", "FILE", "What the machine did and why, PCD");
        const bool& ascii = t.flag("--ascii", "Write PCDs as text");
        t.example("fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan jobs/wang1.json | "
                  "fettle-grind --stock <(fettle-part parts/wang1.json) --gantry virtual:dynamic "
                  "--machine machines/full_scale.json --trace trace.pcd > ground.pcd",
                  "Wang's part 1 from the job to the ground part, on a machine with inertia");
        t.reference("Wang 2007, 5.3.2 and figure 5-7: the layer-based path planning strategy; 6.1.2, eq. 6-1 to 6-8: "
                    "the machine");
        t.parse();
        if ((kind == "virtual:dynamic") == machine.empty())
            throw InputError("--machine", "goes with --gantry virtual:dynamic, and that with it");

        const auto begun = Clock::now();
        const Plan plan = read_plan(plan_file);
        const Units& units = plan.job.units;
        const Scan scan = read_scan(stock_file, units, stock_units);
        if (const std::string doubt = implausible_box(scan.bounds(), plan.job); !doubt.empty())
            t.warn(display_name(stock_file) + ": " + doubt);
        const HeightField stock =
            height_field(scan, plan.job, cell ? *cell * units.mm() : plan.job.wheel.width / kCellsPerWidth,
                         display_name(stock_file));
        std::ostream* trace_out = trace.empty() ? nullptr : &t.output_file(trace); // a wrong name shows before the work
        const std::unique_ptr<VirtualGantry> gantry = make_gantry(machine, stock, plan.job, removal, t.seed());
        RunOptions options;
        options.layer_1 = layer_1 == "feed" ? Layer1::feed : Layer1::constant;
        const GrindRun run = fettle::run(plan, *gantry, options, t.progress("grinding"));

        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        write_pcd(t.output(), to_cloud(stock, gantry->stock()), units, encoding);
        if (trace_out != nullptr) write_pcd(*trace_out, to_cloud(run.trace), units, encoding);
        report(t.report(), run, *gantry, units);
        const double computing = std::chrono::duration<double>(Clock::now() - begun).count();
        t.note("machine time " + std::to_string(gantry->status().time) + " s, computing time " +
               std::to_string(computing) + " s, ratio " + std::to_string(gantry->status().time / computing));
        if (!run.finished) t.warn(display_name(plan_file) + ": " + run.failure);
        return run.finished ? Verdict::yes : Verdict::no;
    });
}
