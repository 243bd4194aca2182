#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle {

/// "x,y,z" as a unit vector.
/// @param source  the option, for messages
/// @throws InputError if these are not three finite numbers, or all are 0
Eigen::Vector3d parse_direction(const std::string& text, const std::string& source);

/// The rotation by the least angle that turns `from` to the direction of `to`; neither is 0, of any length.
Eigen::Matrix3d turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

} // namespace fettle
