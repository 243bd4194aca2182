#pragma once

#include "gantry/gantry.h"
#include "gantry/machine.h"
#include "job/job.h"

#include <optional>

namespace fettle::gantry {

/// What a head that is not trusted can report.
struct HeadCheck {
    double preload = 0;   ///< N
    double stiffness = 0; ///< N/mm
    double max_force = 0; ///< F_max, N
    double tolerance = 0; ///< of the deflection against the force, mm
    double travel = 0;    ///< largest deflection, mm
};

/// @param head  of the machine; nothing: its transducer and its travel are not known. Then the deflection has to be as
/// good as the job needs it: within the tolerance of the ground surface, and to distinguish F_min from no contact.
HeadCheck head_check(const job::Job& job, const std::optional<Head>& head);

/// Force and deflection are two readings of one spring: force = preload + stiffness · deflection. Without deflection
/// the head is on its stop, and the force is at most the preload. A force of F_max or more is that which has stopped
/// the machine; the deflection may be smaller by then.
/// @throws GantryFault with the problem alone, if no head reads this
void check_head(const HeadCheck& head, const GantryStatus& status);

} // namespace fettle::gantry
