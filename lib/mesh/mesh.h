#pragma once

#include <Eigen/Core>

namespace fettle {

/// Triangles over shared vertices, mm, frame M. Counter-clockwise seen from outside.
struct Mesh {
    Eigen::Matrix3Xd vertices;  ///< 3xV
    Eigen::Matrix3Xi triangles; ///< 3xT, columns of `vertices`
};

/// What reading a mesh dropped or mended; goes to the report and to a warning.
struct MeshRepair {
    Eigen::Index dropped_triangles = 0; ///< with NaN or infinite vertices
    Eigen::Index welded_vertices = 0;   ///< equal vertices of neighbouring STL facets made one
};

/// Area-weighted unit normals of the triangles; zero for a triangle without area. 3xT
Eigen::Matrix3Xd triangle_normals(const Mesh& mesh);

/// Smallest box: column 0 is the least corner, column 1 the greatest. NaN and infinite points do not count; without
/// points it is NaN. @param points  3xN
Eigen::Matrix<double, 3, 2> bounding_box(const Eigen::Matrix3Xd& points);

/// The triangles without those that have the corners of an earlier one and face the same way: thousands of them would
/// each be looked at for every point. @param triangles  3xT
Eigen::Matrix3Xi distinct(const Eigen::Matrix3Xi& triangles);

} // namespace fettle
