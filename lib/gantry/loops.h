#pragma once

#include "gantry/machine.h"
#include "gantry/servo.h"
#include "job/job.h"
#include "json/document.h"

#include <string>
#include <vector>

namespace fettle::gantry {

/// A control loop of a machine, tuned for a job.
struct ControlLoop {
    std::string name;     ///< "x", "y", "z", "z against the spring", "c", "force"
    double bandwidth = 0; ///< rad/s
    Margins margins;
};

/// Tunes every loop that a dynamic gantry closes.
/// @throws InputError if there is no controller for one
std::vector<ControlLoop> tune_loops(const Machine& machine, const job::Job& job);

/// {"loop": …, "bandwidth": …, "gain_margin": …, "phase_margin_deg": …}.
json::Value to_json(const ControlLoop& loop);
/// One line of text, "loop x: bandwidth …".
std::string to_string(const ControlLoop& loop);

} // namespace fettle::gantry
