#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// Triangles over points of the plane, counter-clockwise.
struct Triangulation {
    Eigen::Matrix2Xd points;
    Eigen::Matrix3Xi triangles;  ///< indices of points
    Eigen::Matrix3Xi neighbours; ///< the triangle opposite each corner; -1 at the hull
};

/// Delaunay triangulation. Points on one circle (a regular grid) are divided by the diagonals from the least index,
/// whatever the rounding of their coordinates; triangles that are flat within rounding are left off the hull.
/// @param points  2xN, all different
/// @throws InputError for fewer than 3 points or if all lie on a line
Triangulation delaunay(const Eigen::Matrix2Xd& points);

/// The corners of the hull, counter-clockwise: the edges without a neighbour, one after the other.
std::vector<int> hull(const Triangulation& triangulation);

} // namespace fettle
