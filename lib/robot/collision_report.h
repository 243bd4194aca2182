#pragma once

#include "cloud/cloud.h"
#include "robot/collision.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fettle::robot {

/// Index of the minimum clearance, the first of equal ones; -1 if all are NaN.
Eigen::Index min_clearance_index(const std::vector<CellClearance>& list);

/// Parses the indices of poses, "0,12"; an empty text is the pose with the minimum clearance.
/// @throws InputError, starting with the option --at or --picture
std::vector<std::size_t> parse_pose_indices(const std::string& text, const CheckedPath& checked);

/// [name of a, name of b].
json::Value pair_to_json(const Robot& robot, const CellPair& pair);

/// Sets the fields clearance and clearance_between (mm), and for the pair with the minimum clearance at the pose the
/// fields body and other (indices of the bodies in the robot file, from 0; the workpiece comes after the last) and
/// foot_x foot_y foot_z, the nearest or deepest point on body (cell frame, mm). NaN where nothing was measured.
void set_clearances(cloud::Cloud& cloud, const Robot& robot, const CheckedPath& checked);

/// Adds to a report the numbers of poses and of motions between them that collide; the minimum clearances with pair,
/// point, pose and time; and each pair that collides.
/// @param times  at which the poses are reached, s; nothing: not known
/// @return  true if nothing collides
bool add_report(json::Value& report, const Robot& robot, const CheckedPath& checked, const CollisionOptions& options,
                const std::optional<Eigen::VectorXd>& times, const units::Units& units);

} // namespace fettle::robot
