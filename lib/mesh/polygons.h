#pragma once

#include "mesh/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fettle {

/// No real facet has more corners; more would make the cutting, whose time is quadratic, a trap.
inline constexpr std::size_t kMostCorners = 4096;

/// Polygons cut into triangles; those that are triangles stay as they are.
/// @param corners  of all polygons, one after the other: columns of `vertices`, in range
/// @param ends     end of each polygon in `corners`; 3 to kMostCorners each
/// @return  3xT
Eigen::Matrix3Xi cut_polygons(const Eigen::Matrix3Xd& vertices, std::span<const std::uint32_t> corners,
                              std::span<const std::size_t> ends);

/// A simple polygon in space cut into triangles by its ears, as seen along its (area) normal; concave ones too. Corners
/// stay in their order.
/// @param corners  columns of `vertices`, 3 to kMostCorners, in range
/// @return  corners.size() - 2 triples, as columns of `vertices`
std::vector<Eigen::Vector3i> cut_polygon(const Eigen::Matrix3Xd& vertices, std::span<const std::uint32_t> corners);

/// Removes triangles with NaN or infinite corners, and such vertices. @return  how many triangles went
Eigen::Index drop_undefined(Mesh& mesh);

} // namespace fettle
