#pragma once

#include "cloud/cloud.h"
#include "robot/avoid.h"
#include "units/units.h"
#include "json/document.h"

namespace fettle {

/// Fields avoided (0 as it was, 1 tilted, 2 drawn back, 3 both, 4 not solved), tilt (degrees), tilt_towards (degrees
/// about the tool's z from its x) and retreat (mm).
/// @param tolerance  as CollisionOptions, mm
void set_changes(Cloud& cloud, const AvoidedPath& avoided, double tolerance);

/// Where a retreat leads: along normal_x normal_y normal_z where a path has them, else along the tool's axis. 3xN
Eigen::Matrix3Xd retreat_directions(const Cloud& cloud, const PosePath& poses);

/// Adds `avoidance`: counts, the largest tilt, retreat and change of tilt from pose to pose, each change, and what is
/// not solved.
void add_report(json::Value& report, const Robot& robot, const AvoidedPath& avoided, const CheckedPath& before,
                const AvoidOptions& options, const CollisionOptions& collision, const Units& units);

} // namespace fettle
