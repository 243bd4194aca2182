#pragma once

#include "cloud/cloud.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace fettle::cloud {

/// Poses of the tool frame in the part frame along a path; a NaN translation means that a pose is missing.
using PosePath = std::vector<Eigen::Isometry3d>;

/// True if the cloud has the fields qw qx qy qz.
bool has_poses(const Cloud& cloud);

/// Reads the poses of a path from x y z (mm) and the quaternion qw qx qy qz, of any length but 0; NaN: a missing pose.
/// @throws InputError if a field is missing, or a quaternion is 0
PosePath read_poses(const Cloud& cloud);

/// Sets x y z and the fields qw qx qy qz (unit quaternion, qw ≥ 0, F8); other fields stay.
void set_poses(Cloud& cloud, const PosePath& poses);

/// Parses a pose, "x,y,z,qw,qx,qy,qz", mm. @throws InputError unless these are finite numbers and a quaternion
Eigen::Isometry3d parse_pose(const std::string& text);

} // namespace fettle::cloud
