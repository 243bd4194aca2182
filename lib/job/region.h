#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::job {

/// Region of a casting that a point belongs to in plan view (x-y).
enum class Region {
    inside,  ///< in the anomaly's boundary B or on its edge
    around,  ///< in the sampling boundary S, outside B
    outside, ///< outside S; without a sampling boundary, outside B
};

/// Classifies points. @param xyz  3xN, M, mm; a NaN point is outside
std::vector<Region> classify_regions(const Job& job, const Eigen::Matrix3Xd& xyz);

} // namespace fettle::job
