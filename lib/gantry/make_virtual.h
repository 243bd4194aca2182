#pragma once

#include "gantry/virtual_gantry.h"

#include <cstdint>
#include <memory>
#include <string>

namespace fettle::gantry {

struct VirtualMachine {
    std::string file; ///< a machine file; empty: the quasi-static gantry
    double removal_factor = 1;
    std::uint64_t seed = 1;
};

/// @throws InputError for a bad machine file, or a job that does not fit the machine
std::unique_ptr<VirtualGantry> make_virtual_gantry(const removal::HeightField& stock, const job::Job& job,
                                                   const VirtualMachine& machine);

/// Side of a cell of the stock, mm. @param cell  requested side; 0: 64 cells over the wheel's width
double stock_cell_size(const job::Job& job, double cell);

} // namespace fettle::gantry
