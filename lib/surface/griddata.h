#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle {

/// Interpolates the points (Wang 2007, fig. 4-6): Delaunay triangles with a C1 cubic over each (Clough and Tocher), the
/// gradients at the points from least curvature along the edges (Nielson 1983; Renka and Cline 1984). With spacing > 0
/// that surface is sampled on a uniform grid, turned by `angle`, and the grid is interpolated in the same way.
/// @param points  3xN, mm, M; points over the same xy are merged into their mean
/// @param spacing  mm, half the shortest wavelength to keep; 0: interpolated once
/// @throws InputError for fewer than 3 different points, points on a line, NaN, or a spacing that leaves no grid or too
///         many grid points; the message has no file name
Griddata make_griddata(const Eigen::Matrix3Xd& points, double spacing, double angle);

/// The heights of that surface alone, without the weight of each point: what a search over subsets of many points
/// evaluates. @param xy  2xN, M, mm   @return N, NaN outside the convex hull
Eigen::VectorXd griddata_heights(const Eigen::Matrix3Xd& points, double spacing, double angle,
                                 const Eigen::Matrix2Xd& xy);

/// NaN outside the convex hull.
double height(const Griddata& surface, const Eigen::Vector2d& xy);
/// Weight of each point's z in the height (the interpolant is linear in z); NaN outside the convex hull.
Eigen::VectorXd height_gradient(const Griddata& surface, const Eigen::Vector2d& xy);
Eigen::VectorXi parameter_powers(const Griddata& surface);

} // namespace fettle
