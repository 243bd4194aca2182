#pragma once

#include "job/boundary.h"

#include <vector>

namespace fettle::job {

/// The corners of B beyond which S leaves metal to touch; all of them if there is no S. On a side that is open, as
/// where an anomaly hangs over an edge of the part, a corner of B lies on the anomaly.
std::vector<Eigen::Index> corners_on_metal(const Polygon& anomaly, const Polygon& sampling);

} // namespace fettle::job
