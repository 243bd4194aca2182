#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "gantry/simulated_head.h"
#include "job/frame.h"
#include "plan/plan.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Read the stock under the simulated head of LinuxCNC, before and after.", [](cli::Tool& t) {
            const std::string& plan_file = t.positional_file(
                "PLAN", "The plan whose job the machine is set up for, or a job without a plan, to be probed, JSON");
            const gantry::StockOptions stock_options(t);
            const std::string& after = t.optional_file(
                "--after", "FILE", "What the machine left (run/stock.ground): the part in the end, PCD");
            const cloud::CloudOutput out{t};
            t.example("fettle-stock-linuxcnc jobs/wang3.json --stock <(fettle-part parts/wang3.json) > stock",
                      "part 3, to be touched by machines/linuxcnc/start DIR stock");
            t.reference("docs/linuxcnc.md");
            t.parse();

            const auto [job, planned] = plan::read_job_or_plan(plan_file);
            const auto extent = planned ? removal::Extent::anomaly : removal::Extent::sampling;
            auto [stock, doubts, dropped] = gantry::read_stock(stock_options, job, extent);
            for (const std::string& doubt : doubts) t.warn(doubt);
            if (after.empty()) {
                gantry::write_head(t.output(), gantry::head_and_stock(std::move(stock), job));
                return cli::Verdict::yes;
            }
            const removal::HeightField ground = gantry::read_head(after).stock;
            if (ground.columns() != stock.columns() || ground.rows() != stock.rows() || ground.origin != stock.origin ||
                ground.cell != stock.cell)
                throw core::InputError(core::display_name(after), "is not the stock of this part, plan and cell");
            out.write(job::in_job_frame(removal::to_cloud(stock, ground), job), job.units);
            return cli::Verdict::yes;
        });
}
