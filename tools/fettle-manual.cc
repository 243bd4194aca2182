#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "job/frame.h"
#include "job/job.h"
#include "strategy/manual.h"
#include "strategy/run_json.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"

#include <optional>

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::string& job = t.positional_file("JOB", "Wheel, spring, feed and safe height, JSON");
    gantry::StockOptions stock{t};
    const std::string& steering = t.required_file_option(
        "--steer", "EVENTS",
        "The operator's joystick: its device, the keys of /dev/tty, or a file or pipe of lines (- is stdin)");
    gantry::GantryOptions gantry{t,
                                 {.fallback = "",
                                  .choices = "exec:COMMAND",
                                  .gantry = "Driver of a gantry (docs/driver.md), instead of --machine",
                                  .machine = "A simulated machine with drives, JSON"}};
    const std::optional<double>& force =
        t.optional_number("--force", "FORCE", "Set force; default: the job's F_down", core::Range::positive());
    const std::optional<double>& lowest =
        t.optional_number("--lowest", "Z", "Lower bound of the drives' z; default: that of the machine");
    const std::string& trace = t.optional_output("--trace", "What the machine did, PCD, written ahead", {"pcd"});
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-manual jobs/wang1.json --stock <(fettle-part parts/wang1.json) "
              "--machine machines/full_scale.json --steer steering/h.txt --report report.json > ground.pcd",
              "passes over the H of Wang's part 1");
    t.reference("Wang 2007, 6.1.4.1 and figure 6-4: manual mode");
}

void check(const gantry::GantryOptions& gantry)
{
    if (gantry.machine.empty() == gantry.kind.empty())
        throw core::InputError("--machine", "or --gantry must be given, not both");
    if (!gantry.kind.empty() && !gantry.has_driver())
        throw core::InputError("--gantry: '" + gantry.kind + "' is not exec:COMMAND");
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description = "Grind by hand: the operator steers, the machine keeps force and feed.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        check(o.gantry);

        job::Job job = job::read_job(o.job);
        const units::Units& units = job.units;
        const auto [stock, doubts, dropped] = gantry::read_stock(o.stock, job, removal::Extent::sampling);
        job = gantry::with_safe_height_over(stock, std::move(job));
        gantry::require_below_safe_height(stock, job, core::display_name(o.stock.file));
        for (const std::string& doubt : doubts) t.warn(doubt);
        strategy::Steering steering(o.steering);
        const cloud::PcdEncoding encoding = cloud::pcd_encoding(o.out.ascii);
        const auto journal = strategy::open_journal(o.trace, units, encoding, {}, {{}, job.frame()});

        auto [machine, limits, simulated] = gantry::open_gantry(o.gantry, job, stock, t.seed());
        strategy::ManualOptions options;
        options.force = o.force ? *o.force * units.newton() : job.force.down;
        options.lowest = o.lowest ? *o.lowest * units.mm() : limits.min.z();
        options.journal = journal.get();
        const strategy::ManualRun run = strategy::run_manual(job, *machine, steering, options);
        if (simulated == nullptr) machine.reset(); // it lifts now, not after what is computed below
        const removal::HeightField ground =
            simulated ? simulated->stock() : strategy::replay_removal(run.trace, job, stock);

        o.out.write(job::in_job_frame(removal::to_cloud(stock, ground), job), units);
        if (!o.trace.empty() && !(journal && journal->has_failed()))
            strategy::write_trace(t.output_file(o.trace), run.trace, units, encoding, {{}, job.frame()});
        t.report() = strategy::to_json(run, removal::volume_between(stock, ground), o.out.units(units));
        t.report().set("dropped_facets", dropped);
        if (!run.failure.empty()) t.fault(run.failure);
        return run.failure.empty() ? cli::Verdict::yes : cli::Verdict::no;
    });
}
