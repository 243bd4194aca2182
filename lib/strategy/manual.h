#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "strategy/run.h"
#include "strategy/steering.h"

namespace fettle {

/// What came of a manual run.
struct ManualRun {
    std::vector<TraceRow> trace;
    double contact_time = 0; ///< with the wheel on the part, s
    double within = 0;       ///< share of it with the force within a tenth of what was set
    double peak_force = 0;   ///< N
    std::string failure;     ///< the machine's fault; empty: the operator ended it
};

/// Manual mode (Wang 2007, 6.1.4.1): the operator steers, the machine keeps force and feed. Where the stick rests the
/// wheel is lifted, or it would dig in; where it says so, too, and then the machine goes across at the safe height.
/// @param force   to be held, N
/// @param lowest  z, the drives go no lower, mm
ManualRun run_manual(const Job& job, Gantry& gantry, Steering& steering, double force, double lowest,
                     TraceFile* journal);

} // namespace fettle
