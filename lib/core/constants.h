#pragma once

#include <limits>
#include <numbers>

namespace fettle::core {

inline constexpr double kRadPerDegree = std::numbers::pi / 180;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace fettle::core
