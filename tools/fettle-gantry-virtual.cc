#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/descriptor.h"
#include "gantry/gantry_options.h"
#include "gantry/make_virtual.h"
#include "gantry/serve.h"
#include "job/frame.h"
#include "plan/plan.h"

#include <ostream>
#include <unistd.h>

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::string& plan = t.positional_file(
        "PLAN", "The plan whose job the machine is set up for, or a job without a plan, to be probed, JSON");
    gantry::StockOptions stock{t};
    const std::string& machine = t.optional_file(
        "--machine", "FILE", "The machine, JSON; without it the gantry is always in equilibrium, without drives");
    const double& removal_factor = gantry::declare_removal_factor(t);
    const std::string& ground = t.optional_output("--ground", "The ground part at the end", cloud::cloud_formats());
};

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Drive a simulated gantry by the protocol of a real one.", [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-gantry-virtual <(fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan "
                  "jobs/wang1.json) --stock <(fettle-part parts/wang1.json) <<< '1 status'",
                  "the machine's position and force");
        t.reference("docs/driver.md: the protocol");
        t.disable_output();
        t.parse();

        auto [job, planned] = plan::read_job_or_plan(o.plan);
        const removal::Extent extent = planned ? removal::Extent::anomaly : removal::Extent::sampling;
        const auto [stock, doubts, dropped] = gantry::read_stock(o.stock, job, extent);
        for (const std::string& doubt : doubts) t.warn(doubt);
        job = gantry::with_safe_height_over(stock, std::move(job));
        const auto gantry = gantry::make_virtual_gantry(stock, job, {o.machine, o.removal_factor, t.seed()});
        gantry::serve(*gantry, gantry->limits(), job, core::FileDescriptor(::dup(STDIN_FILENO)),
                      core::FileDescriptor(::dup(STDOUT_FILENO)));
        if (!o.ground.empty())
            cloud::write_cloud(t, o.ground, job::in_job_frame(removal::to_cloud(stock, gantry->stock()), job),
                               job.units);
        return cli::Verdict::yes;
    });
}
