#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "gantry/driver.h"
#include "gantry/make_virtual.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "sampling/scan.h"
#include "strategy/manual.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"
#include "json/units.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <ostream>

using namespace fettle;

namespace {

const std::string kDriver = "exec:";

void report_run(json::Value& out, const ManualRun& run, const Units& units)
{
    out.set("kind", "manual")
        .set("units", json::to_json(units))
        .set("contact_time", run.contact_time)
        .set("within", run.within)
        .set("peak_force", run.peak_force / units.newton());
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Grind by hand: the operator steers, the machine keeps force and feed.", [](Tool& t) {
        const std::string& job_file = t.file("JOB", "Wheel, spring, feed and safe height, JSON");
        const std::string& stock_file = t.required_file("--stock", "PART", "The part as it is: STL, PLY, OBJ or PCD");
        const auto& stock_units = t.length_unit("--stock-units", "Unit of PART, if it is not the job's");
        const std::string& steer = t.required_file(
            "--steer", "EVENTS",
            "The operator's stick: a joystick's device, the keys of /dev/tty, or a file or pipe of lines (- is stdin)");
        const std::string& machine = t.other_file("--machine", "FILE", "A simulated machine with drives, JSON");
        const std::string& gantry = t.text("--gantry", "", "exec:COMMAND", "Or a driver (docs/driver.md)");
        const double& patience = t.number("--patience", 10, "SECONDS",
                                          "A driver may answer so much later than the move takes", Range::positive());
        const auto& force =
            t.number_if_given("--force", "FORCE", "To be held; default: the job's F_down", Range::positive());
        const auto& floor = t.number_if_given("--lowest", "Z", "The drives go no lower; default: as far as they reach");
        const auto& cell = t.number_if_given(
            "--cell", "LENGTH", "Side of a cell of the stock; default: 1/64 of the wheel's width", Range::positive());
        const std::string& trace = t.other_output("--trace", "What the machine did, PCD, written ahead");
        const bool& ascii = t.flag("--ascii", "Write PCDs as text");
        t.example("fettle-manual jobs/wang1.json --stock <(fettle-part parts/wang1.json) "
                  "--machine machines/full_scale.json --steer steering/h.txt --report report.json > ground.pcd",
                  "passes over the H of Wang's part 1");
        t.reference("Wang 2007, 6.1.4.1 and figure 6-4: manual mode");
        t.parse();
        if (machine.empty() == gantry.empty()) throw InputError("--machine", "or --gantry must be given, not both");
        if (!gantry.empty() && (gantry.rfind(kDriver, 0) != 0 || gantry == kDriver))
            throw InputError("--gantry: '" + gantry + "' is not exec:COMMAND");

        const Job job = read_job(job_file);
        const Units& units = job.units;
        const HeightField stock =
            height_field(read_scan(stock_file, units, stock_units), job, cell_of(job, cell ? *cell * units.mm() : 0),
                         display_name(stock_file), Extent::sampling);
        Steering steering(steer);
        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        std::ostream* trace_out = trace.empty() ? nullptr : &t.output_file(trace);
        std::unique_ptr<TraceFile> journal;
        if (!trace.empty() && (!std::filesystem::exists(trace) || std::filesystem::is_regular_file(trace)))
            journal = std::make_unique<TraceFile>(trace, units, encoding, std::vector<TraceRow>{});

        std::unique_ptr<VirtualGantry> simulated;
        std::unique_ptr<DriverGantry> driver;
        if (machine.empty())
            driver = std::make_unique<DriverGantry>(gantry.substr(kDriver.size()), job, patience);
        else
            simulated = make_virtual(stock, job, {machine, 1, t.seed()});
        Gantry& at = driver ? static_cast<Gantry&>(*driver) : *simulated;
        const double lowest = floor       ? *floor * units.mm()
                              : simulated ? simulated->limits().least.z()
                                          : driver->limits().least.z();
        const ManualRun run =
            run_manual(job, at, steering, force ? *force * units.newton() : job.force.down, lowest, journal.get());
        const HeightField ground = simulated ? simulated->stock() : ground_by(run.trace, job, stock);
        write_pcd(t.output(), to_cloud(stock, ground), units, encoding);
        if (trace_out != nullptr) write_pcd(*trace_out, to_cloud(run.trace), units, encoding);
        report_run(t.report(), run, units);
        t.report().set("removed_volume", volume_between(stock, ground) / std::pow(units.mm(), 3));
        if (!run.failure.empty()) t.warn(run.failure);
        return run.failure.empty() ? Verdict::yes : Verdict::no;
    });
}
