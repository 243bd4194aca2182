#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle::core {

/// Parses "x,y,z" and normalises the vector.
/// @param source  the option, for messages
/// @throws InputError if these are not three finite numbers, or all are 0
Eigen::Vector3d parse_direction(const std::string& text, const std::string& source);

/// Smallest rotation that turns `from` into the direction of `to`; both have any length but 0.
Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

} // namespace fettle::core
