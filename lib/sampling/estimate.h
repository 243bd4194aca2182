#pragma once

#include "cloud/cloud.h"
#include "job/job.h"

#include <Eigen/Core>

namespace fettle::sampling {

/// Estimates points under the anomaly (Wang 2007, 4.3 and fig. 4-5): a cubic through the four touches of each line, in
/// the vertical plane of the line; at each crossing of two lines, the mean of their two heights. The contact points of
/// a ball are slightly off their line and are moved onto it along a trend through all touches.
/// @param touches  3xN, M, mm
/// @param curve    N, line of each touch
/// @param role     N; only roles near_anomaly and near_sampling_boundary are used, and of those the touches on a line
/// @return 3xK, M, mm; ordered by the lines along Y_w, then along each line
/// @throws InputError if a line does not have four touches at four different places
Eigen::Matrix3Xd estimated_points(const job::Job& job, const Eigen::Matrix3Xd& touches, const Eigen::VectorXi& curve,
                                  const Eigen::VectorXi& role);

/// Appends the estimated points to the samples, with role 3 and every other field NaN (0 in integer fields). Samples of
/// a plane or a swept surface, and samples without lines, are returned unchanged.
/// @throws InputError also if the fields curve and role are missing, or if there are estimated points already
cloud::Cloud with_estimated_points(const job::Job& job, const cloud::Cloud& samples);

} // namespace fettle::sampling
