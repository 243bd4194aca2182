#pragma once

#include "cloud/cloud.h"
#include "job/job.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Points under the anomaly (Wang 2007, 4.3 and fig. 4-5): a cubic through the four touches of each line, in the
/// vertical plane of the line; at each crossing of two lines, the mean of their two heights. Touches of a ball lie a
/// little beside their line; they are moved onto it along a trend through all touches.
/// @param touches  3xN, M, mm
/// @param curve    N, the line of each touch
/// @param role     N; only touches near the anomaly and near the sampling boundary count (1, 2)
/// @return 3xK, M, mm; the lines along Y_w in order, on each the crossings in order
/// @throws InputError if a line has not four touches at four different places
Eigen::Matrix3Xd estimated_points(const Job& job, const Eigen::Matrix3Xd& touches, const Eigen::VectorXi& curve,
                                  const Eigen::VectorXi& role);

/// Samples with their estimated points appended: role 3, curve and every other field NaN (0 in fields of integers).
/// Samples of a plane or a swept surface, and samples on no lines, have none and come back as they are.
/// @throws InputError also if the fields curve and role are missing, or if there are estimated points already
Cloud with_estimated_points(const Job& job, const Cloud& samples);

} // namespace fettle
