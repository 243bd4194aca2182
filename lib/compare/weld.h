#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace fettle::compare {

/// Lengths below this are rounding of a float coordinate of that size, mm.
double float_rounding(double coordinate);

/// Typical distance of a mesh from the origin, mm: the median over its finite vertices of the largest |coordinate|, so
/// that a few stray vertices have no influence; 0 without a finite vertex. @param vertices  3xV, mm
double median_coordinate(const Eigen::Matrix3Xd& vertices);

/// Welds vertices: maps each candidate to the lowest one in its chain of candidates within `tolerance` of each other.
/// @param vertices    3xV, mm   @param candidates  columns of `vertices`, ascending, finite
/// @param tolerance   at a vertex, mm; nearly the same for neighbours
/// @return  a column of `vertices` for each candidate
std::vector<std::int32_t> weld(const Eigen::Matrix3Xd& vertices, const std::vector<std::int32_t>& candidates,
                               const std::function<double(const Eigen::Vector3d&)>& tolerance);

} // namespace fettle::compare
