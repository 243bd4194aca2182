#include "gantry/make_virtual.h"

#include "gantry/dynamic.h"
#include "gantry/quasi_static.h"

namespace fettle::gantry {
namespace {

constexpr double kCellsPerWidth = 64; // of the wheel: cells of 0.1 mm for 1/4 in

} // namespace

std::unique_ptr<VirtualGantry> make_virtual_gantry(const removal::HeightField& stock, const job::Job& job,
                                                   const VirtualMachine& machine)
{
    if (machine.file.empty()) {
        QuasiStaticOptions options;
        options.removal_factor = machine.removal_factor;
        return std::make_unique<QuasiStaticGantry>(stock, job, options);
    }
    DynamicOptions options;
    options.removal_factor = machine.removal_factor;
    options.seed = machine.seed;
    return std::make_unique<DynamicGantry>(stock, job, read_machine(machine.file), options);
}

double stock_cell_size(const job::Job& job, double cell) { return cell > 0 ? cell : job.wheel.width / kCellsPerWidth; }

} // namespace fettle::gantry
