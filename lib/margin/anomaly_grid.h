#pragma once

#include "job/job.h"

#include <Eigen/Core>

namespace fettle::margin {

/// Places inside B to evaluate errors at: a grid in W with about `across` points along the longer side, and points
/// along the edge with the same spacing.
/// @return 2xN, M, mm; the corners of B come first, of those much closer together than the grid only one
Eigen::Matrix2Xd anomaly_grid(const job::Job& job, int across);

} // namespace fettle::margin
