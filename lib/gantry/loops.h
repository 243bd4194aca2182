#pragma once

#include "gantry/machine.h"
#include "gantry/servo.h"
#include "job/job.h"

#include <string>
#include <vector>

namespace fettle {

/// A loop of a machine, as it was tuned for a job.
struct Loop {
    std::string name;     ///< "x", "y", "z", "z against the spring", "c", "force"
    double bandwidth = 0; ///< rad/s
    Margins margins;
};

/// Every loop that a dynamic gantry closes.
/// @throws InputError if there is no controller for one
std::vector<Loop> loops_of(const Machine& machine, const Job& job);

} // namespace fettle
