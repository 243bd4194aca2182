#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace fettle::machining {

/// Tips within this distance of a straight move are left out of a path, mm.
inline constexpr double kThinningTolerance = 1e-4;

/// Index of the last tip such that a straight move from the first to it passes all tips between within
/// kThinningTolerance. This is greedy polyline simplification, one move at a time.
/// @param tips  not empty
std::size_t last_on_line(std::span<const Eigen::Vector3d> tips);

} // namespace fettle::machining
