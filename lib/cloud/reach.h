#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle::cloud {

/// Checks that coordinates are no larger than those of any part or scan, so that squares and numbers of cells cannot
/// overflow. NaN and infinite coordinates pass, because they mark missing points.
/// @param xyz     3xN, mm
/// @param source  name for messages
/// @throws InputError with the index of the point
void check_coordinate_range(const Eigen::Matrix3Xd& xyz, const std::string& source);

} // namespace fettle::cloud
