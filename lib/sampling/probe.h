#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "sampling/noise.h"
#include "sampling/scan.h"
#include "sampling/touch_plan.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::sampling {

/// Simulates the touches of a plan on a scan. With a ball tip (job.probe.tip_radius > 0) the touches are contact
/// points, which are slightly off the planned places on a slope: see contact_points.
/// @return 3xN, M, mm, in the order of the plan; z is NaN where no surface was found
/// @throws InputError if the tip is larger than the anomaly
Eigen::Matrix3Xd probe(const Scan& scan, const job::Job& job, const TouchPlan& plan, const TouchNoise& noise,
                       std::uint64_t seed);

/// Checks that all touches found the surface.
/// @param source  name of the scan for messages   @param hint  a possible cause, appended to the message; may be empty
/// @throws InputError that lists the places where no surface was found
void check_all_touched(const Eigen::Matrix3Xd& touches, const job::Job& job, const TouchPlan& plan,
                       const std::string& source, const std::string& hint);

/// Touches as a cloud with the fields curve and role. @param order  indices of the touches, possibly not all of them
cloud::Cloud sample_cloud(const Eigen::Matrix3Xd& touches, const TouchPlan& plan,
                          const std::vector<Eigen::Index>& order);

/// Contact points of a ball with the surface (tip compensation). A probe measures the centre of its ball, not the
/// direction of the contact, and the centre minus R along z is off a sloping surface. The centres are on the offset
/// surface at distance R, which has the same normals, so the contact point is centre - R n with the normal n of a trend
/// through the centres. An error δn moves it along the surface; off the surface only by R |δn|²/2.
/// @param centres  3xN, M, mm; NaN: no touch
Eigen::Matrix3Xd contact_points(const job::Job& job, const Eigen::Matrix3Xd& centres, double radius);

} // namespace fettle::sampling
