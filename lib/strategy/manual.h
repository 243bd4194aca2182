#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "strategy/run.h"
#include "strategy/steering.h"

namespace fettle::strategy {

/// Result of a manual run.
struct ManualRun {
    std::vector<TraceRow> trace;
    double contact_time = 0;  ///< with the wheel on the part, s
    double share_in_band = 0; ///< share of it with the force within a tenth of the set force
    double peak_force = 0;    ///< N
    std::string failure;      ///< the machine's fault; empty: the operator ended the run
};

/// Manual mode (Wang 2007, 6.1.4.1): the operator steers, the machine controls force and feed. While the stick is
/// centred the wheel is lifted, or it would dig in. With the stick's `on_part` false it is lifted, too, and the machine
/// moves across at the safe height.
/// @param force    set force, N
/// @param lowest   lower bound of the drives' z, mm
/// @param journal  nullptr: none
ManualRun run_manual(const job::Job& job, gantry::Gantry& gantry, Steering& steering, double force, double lowest,
                     TraceFile* journal);

} // namespace fettle::strategy
