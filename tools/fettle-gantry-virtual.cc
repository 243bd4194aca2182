#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/descriptor.h"
#include "core/file.h"
#include "gantry/make_virtual.h"
#include "gantry/serve.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "sampling/scan.h"

#include <ostream>
#include <unistd.h>

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Drive a simulated gantry by the protocol of a real one.", [](Tool& t) {
        const std::string& plan_file =
            t.file("PLAN", "The plan whose job the machine is set up for, or a job without a plan, to be probed, JSON");
        const std::string& stock_file = t.required_file("--stock", "PART", "The part as it is: STL, PLY, OBJ or PCD");
        const auto& stock_units = t.length_unit("--stock-units", "Unit of PART, if it is not the job's");
        const std::string& machine =
            t.other_file("--machine", "FILE", "The machine, JSON; left out: one in equilibrium at every moment");
        const double& removal = t.number("--removal-factor", 1, "FACTOR",
                                         "The stock yields so many times as fast as the job says", Range::positive());
        const auto& cell = t.number_if_given(
            "--cell", "LENGTH", "Side of a cell of the stock; default: 1/64 of the wheel's width", Range::positive());
        const std::string& ground = t.other_output("--ground", "The part in the end, PCD");
        t.example("fettle-gantry-virtual <(fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan "
                  "jobs/wang1.json) --stock <(fettle-part parts/wang1.json) <<< '1 status'",
                  "where the machine stands");
        t.reference("docs/driver.md: the protocol");
        t.without_output();
        t.parse();

        const auto [job, planned] = read_work(plan_file);
        const Units& units = job.units;
        const HeightField stock =
            height_field(read_scan(stock_file, units, stock_units), job, cell_of(job, cell ? *cell * units.mm() : 0),
                         display_name(stock_file), planned ? Extent::anomaly : Extent::sampling);
        std::ostream* out = ground.empty() ? nullptr : &t.output_file(ground);
        const std::unique_ptr<VirtualGantry> gantry = make_virtual(stock, job, {machine, removal, t.seed()});
        serve(*gantry, gantry->limits(), job, Descriptor(::dup(STDIN_FILENO)), Descriptor(::dup(STDOUT_FILENO)));
        if (out != nullptr) write_pcd(*out, to_cloud(stock, gantry->stock()), units, PcdEncoding::binary);
        return Verdict::yes;
    });
}
