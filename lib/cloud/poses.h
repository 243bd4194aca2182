#pragma once

#include "cloud/cloud.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace fettle::cloud {

/// Poses of the tool frame in the part frame along a path; a NaN translation means that a pose is missing.
using PosePath = std::vector<Eigen::Isometry3d>;

/// Reads the poses of a path from x y z (mm) and the quaternion qw qx qy qz, of any length but 0; NaN: a missing pose.
/// @throws InputError if a field is missing, or a quaternion is 0
PosePath read_poses(const Cloud& cloud);

/// Sets x y z and the fields qw qx qy qz (unit quaternion, qw ≥ 0, F8); other fields stay.
void set_poses(Cloud& cloud, const PosePath& poses);

/// How the tool comes to a point of a path, field `motion`.
enum class Motion {
    stroke = 0,   ///< in contact with the part
    approach = 1, ///< along its axis, near the part, to a stroke or from it
    lead = 2,     ///< along its axis, farther off
    travel = 3    ///< from stroke to stroke, clear of the part
};

/// The field `motion` of each point; without it strokes are points whose `stroke`, if there is one, is not negative,
/// and the others are travel.
/// @throws InputError for a value that is none of them
std::vector<Motion> read_motions(const Cloud& cloud);

/// The field `stroke`, from 0, -1 between strokes; without it the field `pass`, without both 0.
Eigen::VectorXd read_strokes(const Cloud& cloud);

/// Parses a pose, "x,y,z,qw,qx,qy,qz", mm. @throws InputError unless these are finite numbers and a quaternion
Eigen::Isometry3d parse_pose(const std::string& text);

} // namespace fettle::cloud
