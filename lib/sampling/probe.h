#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "sampling/noise.h"
#include "sampling/scan.h"
#include "sampling/touch_plan.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle {

/// Touches the part at the planned places. With a tip (job.probe.tip_radius > 0) the touches are points of contact, a
/// little beside the planned places on a slope: see contact_points.
/// @return 3xN, M, mm, in the order of the plan; z is NaN where no surface was found
/// @throws InputError for a tip that is larger than the anomaly
Eigen::Matrix3Xd probe(const Scan& scan, const Job& job, const TouchPlan& plan, const TouchNoise& noise,
                       std::uint64_t seed);

/// @param source  the scan's name in messages   @param doubt  what else may be wrong with it; empty: nothing
/// @throws InputError naming the places where no surface was found, if there are any
void check_touched(const Eigen::Matrix3Xd& touches, const Job& job, const TouchPlan& plan, const std::string& source,
                   const std::string& doubt);

/// Touches as points with the fields curve and role. @param order  of the touches, which need not be all
Cloud sample_cloud(const Eigen::Matrix3Xd& touches, const TouchPlan& plan, const std::vector<Eigen::Index>& order);

/// Where a ball that came down touched the surface. A real probe knows its centre, not the direction of the contact:
/// the centre minus the radius along z lies off the surface wherever it slopes. The centres lie on the surface's
/// parallel at distance R, which has the same normals, so the normal n of a trend through the centres gives the contact
/// as centre - R n. An error of n moves that point along the surface; off it only by the square of the error, R
/// |δn|²/2.
/// @param centres  3xN, M, mm; NaN: no touch
Eigen::Matrix3Xd contact_points(const Job& job, const Eigen::Matrix3Xd& centres, double radius);

} // namespace fettle
