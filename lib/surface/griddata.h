#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle::surface {

/// Interpolates the points (Wang 2007, fig. 4-6): a Delaunay triangulation with a C1 cubic over each triangle (Clough
/// and Tocher), gradients at the points by minimum curvature along the edges (Nielson 1983; Renka and Cline 1984). With
/// spacing > 0 that surface is sampled on a uniform grid, rotated by `angle`, and interpolated again.
/// @param points  3xN, mm, M; points with the same xy are merged into their mean
/// @param spacing  mm, half the shortest wavelength to keep; 0: no second interpolation
/// @throws InputError for fewer than 3 different points, points on a line, NaN, or a spacing that leaves no grid or too
///         many grid points; the message has no file name
Griddata make_griddata(const Eigen::Matrix3Xd& points, double spacing, double angle);

/// Heights of the same surface without the weights of the points, which makes it fast enough for a search over subsets
/// of many points. @param xy  2xN, M, mm   @return N, NaN outside the convex hull
Eigen::VectorXd griddata_heights(const Eigen::Matrix3Xd& points, double spacing, double angle,
                                 const Eigen::Matrix2Xd& xy);

/// z over xy, M, mm; NaN outside the convex hull.
double height(const Griddata& surface, const Eigen::Vector2d& xy);
/// Weight of each point's z in the height, which is linear in z; NaN outside the convex hull.
Eigen::VectorXd height_gradient(const Griddata& surface, const Eigen::Vector2d& xy);

} // namespace fettle::surface
