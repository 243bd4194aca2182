#pragma once

#include "cloud/cloud.h"
#include "mesh/triangle.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace fettle::mesh {

/// Triangles over shared vertices, mm, frame M; counter-clockwise seen from outside.
struct Mesh {
    Eigen::Matrix3Xd vertices;  ///< 3xV
    Eigen::Matrix3Xi triangles; ///< 3xT, indices of columns of `vertices`
    cloud::Frame frame = cloud::Frame::part;
};

/// The corners of a triangle of a mesh.
inline Triangle triangle_of(const Mesh& mesh, Eigen::Index index)
{
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, index));
    return corners;
}

/// What read_mesh() dropped or repaired; tools report it and warn.
struct MeshRepair {
    Eigen::Index dropped_triangles = 0; ///< triangles with NaN or infinite vertices
    Eigen::Index welded_vertices = 0;   ///< equal vertices of STL facets merged into one
    Eigen::Index unused_vertices = 0;   ///< vertices of no triangle, dropped
};

/// Sentence for a warning about what was dropped; empty if nothing was.
std::string repair_warning(const MeshRepair& repair);

/// Unit normals of the triangles, 3xT; zero for degenerate triangles.
Eigen::Matrix3Xd triangle_normals(const Mesh& mesh);

/// Removes triangles with the same corners and orientation as an earlier one. Otherwise a closest point query would
/// measure all duplicates. @param triangles  3xT
Eigen::Matrix3Xi unique_triangles(const Eigen::Matrix3Xi& triangles);

/// Triangles that have the corners of an earlier one in the opposite orientation, as the second sides of a mesh that is
/// drawn from both sides: where they lie, outside is on neither side. @param triangles  3xT   @return  ascending
std::vector<std::uint32_t> opposite_triangles(const Eigen::Matrix3Xi& triangles);

} // namespace fettle::mesh
