#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle::core {

/// Sorts points along a Morton curve through their bounding box, which interleaves the bits of the coordinates: mostly,
/// successive points are near each other. Points in one cell keep their order; points that are not finite come last.
/// @param points  3xN, less than 2^32 of them
std::vector<std::uint32_t> morton_order(const Eigen::Matrix3Xd& points);

} // namespace fettle::core
