#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "strategy/run.h"
#include "strategy/steering.h"

#include <functional>
#include <string>
#include <vector>

namespace fettle::strategy {

/// Result of a manual run.
struct ManualRun {
    std::vector<TraceRow> trace;
    double contact_time = 0;  ///< with the wheel on the part, s
    double share_in_band = 0; ///< share of it with the force within a tenth of the set force
    double peak_force = 0;    ///< N
    std::string failure;      ///< the machine's fault; empty: the operator ended the run
    double steering_time = 0; ///< at the end, s
};

struct ManualOptions {
    double force = 0;             ///< to be held, N
    double lowest = 0;            ///< lower bound of the drives' z, mm
    TraceFile* journal = nullptr; ///< nullptr: none
    double steering_time = 0;     ///< at the beginning, s
    /// Called for each reading of the stick; false ends the run. Empty: only Stick::end does.
    std::function<bool(const Stick&, const gantry::GantryStatus&)> go_on;
};

/// Manual mode (Wang 2007, 6.1.4.1): the operator steers, the machine controls force and feed. While the stick is
/// centred the wheel is lifted, or it would dig in. With the stick's `on_part` false it is lifted, too, and the machine
/// moves across at the safe height. It ends with the wheel at the safe height, also after an interruption
/// (gantry::Interrupted).
ManualRun run_manual(const job::Job& job, gantry::Gantry& gantry, Steering& steering, const ManualOptions& options);

} // namespace fettle::strategy
