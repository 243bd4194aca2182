#pragma once

#include "sampling/touch_plan.h"

namespace fettle {

/// Plane (Wang 2007, 4.4.4, 1): the anomaly's boundary points are the touches.
/// @throws InputError for fewer than 4 points, asking for the missing ones
TouchPlan plan_plane(const Job& job);

} // namespace fettle
