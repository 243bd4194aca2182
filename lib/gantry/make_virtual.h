#pragma once

#include "gantry/virtual_gantry.h"

#include <cstdint>
#include <memory>
#include <string>

namespace fettle {

struct VirtualMachine {
    std::string file; ///< a machine file; empty: the quasi-static gantry
    double removal_factor = 1;
    std::uint64_t seed = 1;
};

/// @throws InputError for a bad machine file, or a job that does not go with it
std::unique_ptr<VirtualGantry> make_virtual(const HeightField& stock, const Job& job, const VirtualMachine& machine);

/// Side of a cell of the stock, mm. @param wanted  0: 64 cells over the wheel's width
double cell_of(const Job& job, double wanted);

} // namespace fettle
