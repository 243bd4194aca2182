#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace fettle {

/// Lengths below this are the rounding of a float coordinate, mm.
double float_rounding(double coordinate);

/// How far from the origin a mesh lies, mm: the median over its vertices of the largest coordinate; a few stray
/// vertices far away say nothing about the others. 0 without a finite vertex. @param vertices  3xV, mm
double typical_coordinate(const Eigen::Matrix3Xd& vertices);

/// For each candidate the lowest of those within `tolerance(candidate)` of it (and of those, and so on).
/// @param vertices    3xV, mm   @param candidates  columns of `vertices`, ascending, finite
/// @param tolerance   mm, nearly the same for neighbours
std::vector<std::int32_t> weld(const Eigen::Matrix3Xd& vertices, const std::vector<std::int32_t>& candidates,
                               const std::function<double(const Eigen::Vector3d&)>& tolerance);

} // namespace fettle
