#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "gantry/make_virtual.h"
#include "gantry/simulated_head.h"
#include "plan/plan.h"
#include "sampling/scan.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "The stock under the simulated head of LinuxCNC: before and after.", [](Tool& t) {
        const std::string& plan_file =
            t.file("PLAN", "The plan whose job the machine is set up for, or a job without a plan, to be probed, JSON");
        const std::string& stock_file = t.required_file("--stock", "PART", "The part as it is: STL, PLY, OBJ or PCD");
        const auto& stock_units = t.length_unit("--stock-units", "Unit of PART, if it is not the job's");
        const auto& cell = t.number_if_given(
            "--cell", "LENGTH", "Side of a cell of the stock; default: 1/64 of the wheel's width", Range::positive());
        const std::string& after =
            t.other_file("--after", "FILE", "What the machine left (run/stock.ground): the part in the end, PCD");
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-stock-linuxcnc jobs/wang3.json --stock <(fettle-part parts/wang3.json) > stock",
                  "part 3, to be touched by machines/linuxcnc/start DIR stock");
        t.reference("docs/linuxcnc.md");
        t.parse();

        const auto [job, planned] = read_work(plan_file);
        HeightField stock = height_field(read_scan(stock_file, job.units, stock_units), job,
                                         cell_of(job, cell ? *cell * job.units.mm() : 0), display_name(stock_file),
                                         planned ? Extent::anomaly : Extent::sampling);
        if (after.empty()) {
            write_head(t.output(), head_and_stock(std::move(stock), job));
            return Verdict::yes;
        }
        const HeightField ground = read_head(after).stock;
        if (ground.columns() != stock.columns() || ground.rows() != stock.rows() || ground.origin != stock.origin ||
            ground.cell != stock.cell)
            throw InputError(display_name(after), "is not the stock of this part, plan and cell");
        write_pcd(t.output(), to_cloud(stock, ground), job.units, ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        return Verdict::yes;
    });
}
