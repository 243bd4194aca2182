#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::surface {

/// Triangulation of points in the plane.
struct Triangulation {
    Eigen::Matrix2Xd points;
    Eigen::Matrix3Xi triangles;  ///< indices of points, counter-clockwise
    Eigen::Matrix3Xi neighbours; ///< index of the triangle opposite each corner; -1 at the hull
};

/// Delaunay triangulation, from Boost's Voronoi diagram. Cocircular points (a regular grid) give the fan from the
/// lowest index, whatever the rounding of their coordinates. Hull triangles that are flat within rounding are left out.
/// @param points  2xN, all different
/// @throws InputError for fewer than 3 points or if all are collinear
Triangulation delaunay(const Eigen::Matrix2Xd& points);

/// Indices of the points on the convex hull, counter-clockwise.
std::vector<int> hull_corners(const Triangulation& triangulation);

} // namespace fettle::surface
