#pragma once

#include "sampling/touch_plan.h"

namespace fettle::sampling {

/// Touch plan of a plane (Wang 2007, 4.4.4, 1): the touches are the anomaly's boundary points, but for those at which
/// the sampling boundary leaves no metal (job::corners_on_metal).
/// @throws InputError for fewer than 4 points   @throws NoRoomError if fewer than 4 are left
TouchPlan plan_plane(const job::Job& job);

} // namespace fettle::sampling
