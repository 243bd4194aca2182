#pragma once

#include "gantry/gantry.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <string_view>
#include <vector>

/// Lines between a strategy and the driver of a machine: docs/driver.md. Numbers are in mm, N, s, with as many digits
/// as they need to be read back exactly.
namespace fettle::gantry::protocol {

inline const std::string kVersion = "fettle-gantry 1";

/// Limits of a machine, in the frame M; a driver reports them first.
struct Limits {
    Eigen::Vector3d min, max; ///< range of the tool point, mm
    double speed = 0;         ///< of any axis and any combination of axes, mm/s
    double force = 0;         ///< largest F_max that it accepts, N
};

/// A move may end this far from its target, where a machine rounds the corner to the next one.
inline constexpr double kPositionTolerance = 5; // mm

std::string to_words(const Eigen::Vector3d& point);
std::string to_words(const Eigen::Isometry3d& pose); ///< x y z and the unit quaternion w x y z
std::string to_line(const Limits& limits);
std::string to_line(const GantryStatus& status);

/// All four: @throws GantryFault that quotes the text, if it is malformed or a number is not finite; for a pose also
/// unless the quaternion's length is 1
Limits parse_limits(std::string_view text);
GantryStatus parse_status(std::string_view text);
Eigen::Isometry3d parse_pose(std::string_view text);
double parse_finite_number(std::string_view text);

/// Removes the first word from a line, and returns it; words are separated by one blank.
std::string_view next_word(std::string_view& line);

} // namespace fettle::gantry::protocol
