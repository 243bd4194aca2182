#pragma once

#include "cloud/cloud.h"
#include "robot/avoid.h"
#include "units/units.h"
#include "json/document.h"

namespace fettle::robot {

/// Sets the fields avoided (0 unchanged, 1 tilted, 2 retreated, 3 both, 4 not solved), tilt (degrees), tilt_towards
/// (azimuth of the tilt, degrees about the tool's z from its x; NaN without a tilt) and retreat (mm).
/// @param tolerance  CollisionOptions::tolerance, mm
void set_changes(cloud::Cloud& cloud, const AvoidedPath& avoided, double tolerance);

/// Directions of retreats: the fields normal_x normal_y normal_z where a path has them, else the tool's axis.
/// @return  3xN, unit, part frame
Eigen::Matrix3Xd retreat_directions(const cloud::Cloud& cloud, const cloud::PosePath& poses);

/// Adds `avoidance` to a report: counts, the largest tilt, retreat and change of tilt from pose to pose, each changed
/// pose, and each pose that is not solved.
void add_report(json::Value& report, const Robot& robot, const AvoidedPath& avoided, const CheckedPath& before,
                const AvoidOptions& options, const CollisionOptions& collision, const units::Units& units);

} // namespace fettle::robot
