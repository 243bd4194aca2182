#pragma once

#include "job/job.h"

#include <Eigen/Core>

namespace fettle {

/// Places inside B where its errors are looked at: a grid in W of about `across` points over the longer side, and
/// points along the edge, as far apart. @return 2xN, M, mm; the corners of B come first (of those much nearer together
/// than the grid one)
Eigen::Matrix2Xd anomaly_grid(const Job& job, int across);

} // namespace fettle
