#include "gantry/make_virtual.h"

#include "gantry/dynamic.h"
#include "gantry/quasi_static.h"

namespace fettle {
namespace {

constexpr double kCellsPerWidth = 64; // of the wheel: 0.1 mm for one of 1/4 in

} // namespace

std::unique_ptr<VirtualGantry> make_virtual(const HeightField& stock, const Job& job, const VirtualMachine& machine)
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

double cell_of(const Job& job, double wanted) { return wanted > 0 ? wanted : job.wheel.width / kCellsPerWidth; }

} // namespace fettle
