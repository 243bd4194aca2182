#pragma once

#include "gantry/gantry.h"

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

/// Lines between a strategy and the driver of a machine: docs/driver.md. Numbers in mm, N, s, written so that they read
/// back the same.
namespace fettle::protocol {

inline const std::string kVersion = "fettle-gantry 1";

/// What a machine can do; a driver tells it first. The frame is M.
struct Limits {
    Eigen::Vector3d least, most; ///< of the tool point, mm
    double speed = 0;            ///< no axis and no combination of axes is faster, mm/s
    double force = 0;            ///< the largest F_max it can be given, N
};

std::string text_of(const Limits& limits);
std::string text_of(const GantryStatus& status);

/// @throws GantryFault with what was said, if that is not what it should be: also for numbers that are not finite
Limits limits_in(std::string_view text);
GantryStatus status_in(std::string_view text);
double number_in(std::string_view text);

/// A line without its first word, which is returned; words are separated by one blank.
std::string_view next_word(std::string_view& line);

} // namespace fettle::protocol
