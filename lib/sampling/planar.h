#pragma once

#include "sampling/touch_plan.h"

namespace fettle::sampling {

/// Touch plan of a plane (Wang 2007, 4.4.4, 1): the touches are the anomaly's boundary points.
/// @throws InputError for fewer than 4 points
TouchPlan plan_plane(const job::Job& job);

} // namespace fettle::sampling
