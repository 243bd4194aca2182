#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace fettle {

/// Tips that a straight move passes by no farther than this are left out of a path, mm.
inline constexpr double kThinning = 1e-4;

/// The last of some tips, one at least, that one straight move can go to from the first, past those between.
std::size_t straight_to(std::span<const Eigen::Vector3d> tips);

} // namespace fettle
