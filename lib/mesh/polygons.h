#pragma once

#include "mesh/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fettle::mesh {

/// Largest number of corners accepted. No real facet has more, and triangulation takes quadratic time.
inline constexpr std::size_t kMaxPolygonCorners = 4096;

/// Triangulates polygons.
/// @param corners  corners of all polygons, one after the other: indices of columns of `vertices`, in range
/// @param ends     end of each polygon in `corners`; each has 3 to kMaxPolygonCorners
/// @return  3xT
Eigen::Matrix3Xi triangulate_polygons(const Eigen::Matrix3Xd& vertices, std::span<const std::uint32_t> corners,
                                      std::span<const std::size_t> ends);

/// Triangulates a simple polygon in space, convex or not, by ear clipping in projection along its normal. The triangles
/// keep the orientation.
/// @param corners  indices of columns of `vertices`, 3 to kMaxPolygonCorners, in range
/// @return  corners.size() - 2 triangles, as indices of columns of `vertices`
std::vector<Eigen::Vector3i> triangulate_polygon(const Eigen::Matrix3Xd& vertices,
                                                 std::span<const std::uint32_t> corners);

/// Removes NaN and infinite vertices and the triangles that have such corners. @return  number of triangles removed
Eigen::Index drop_nonfinite(Mesh& mesh);

/// Removes vertices that are no triangle's corner. @return  number of vertices removed
Eigen::Index drop_unused_vertices(Mesh& mesh);

} // namespace fettle::mesh
