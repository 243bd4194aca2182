#pragma once

#include "cloud/cloud.h"
#include "robot/collision.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>

#include <optional>

namespace fettle {

/// Where the least of a list is, the first of several; -1 if all are NaN.
Eigen::Index least_of(const std::vector<CellClearance>& list);

/// Fields clearance and clearance_between (mm), and of the least clearance of the pose body, other (numbers of the
/// bodies in the robot file, from 0; the workpiece's is their number) and foot_x foot_y foot_z, the point on body (in
/// the cell). NaN where nothing was looked at.
void set_clearances(Cloud& cloud, const Robot& robot, const CheckedPath& checked);

/// Adds how many poses, and ways between them, collide; the least clearances, between whom, where, at which pose and
/// when; and each pair that collides.
/// @param times  of the poses, s; nothing: not known
/// @return  does nothing collide?
bool add_report(json::Value& report, const Robot& robot, const CheckedPath& checked, const CollisionOptions& options,
                const std::optional<Eigen::VectorXd>& times, const Units& units);

} // namespace fettle
