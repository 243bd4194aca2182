#pragma once

#include "cloud/cloud.h"

#include <Eigen/Geometry>

#include <vector>

namespace fettle {

/// Poses of the path's tool frame in the part's; a NaN translation: no pose.
using PosePath = std::vector<Eigen::Isometry3d>;

/// Has it the fields qw qx qy qz?
bool has_poses(const Cloud& cloud);

/// Poses of a path: x y z (mm) and the quaternion qw qx qy qz, of any length but 0. NaN: no pose.
/// @throws InputError if a field is missing, or a quaternion is 0
PosePath path_poses(const Cloud& cloud);

/// x y z and qw qx qy qz (unit, qw not negative, F8); other fields stay.
void set_path(Cloud& cloud, const PosePath& poses);

} // namespace fettle
