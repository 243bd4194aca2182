#pragma once

#include "job/job.h"

#include <cmath>

namespace fettle::job {

/// Sets the safe height of a job that gives neither it nor the z of a boundary point: over the part's own top.
/// @param highest  z of that top, mm; NaN: not known, which changes nothing
inline void set_safe_height_over(Job& job, double highest)
{
    if (job.is_safe_height_known || !std::isfinite(highest)) return;
    job.safe_height = highest + kTravelClearance;
    job.is_safe_height_known = true;
}

} // namespace fettle::job
