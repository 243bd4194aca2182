#pragma once

// For the files of this module alone.

#include "mesh/triangle.h"

#include <Adaptor3d_Surface.hxx>

#include <Eigen/Core>

namespace fettle::cad {

/// A triangle of a face, with the parameters of its corners on the surface.
struct FaceTriangle {
    mesh::Triangle corners; ///< mm
    Eigen::Matrix<double, 2, 3> uv;
    /// For u and v the corners in which it means nothing, as at the apex of a cone or the pole of a sphere. The
    /// parameter of a point is then that of the other corners, by their weights: where there is one such corner, that
    /// of the line from there through the point to the opposite side.
    Eigen::Array<bool, 2, 3> is_singular = Eigen::Array<bool, 2, 3>::Constant(false);

    /// Parameters of the point with these barycentric coordinates.
    Eigen::Vector2d parameters(const Eigen::Vector3d& barycentric) const;
};

/// Finds the singular corners.
FaceTriangle face_triangle(const Adaptor3d_Surface& surface, const mesh::Triangle& corners,
                           const Eigen::Matrix<double, 2, 3>& uv);

/// How a point of a triangle is mapped to the surface.
enum class Correspondence {
    by_parameters, ///< to the point with the same parameters: quick, and close where the surface is nearly flat
    closest_point  ///< to its foot
};

/// Upper bound of the distances between the points of a triangle and those of the surface that they correspond to, mm.
/// It is taken over a grid of the triangle; between the grid's points the surface differs from the plane through three
/// of them by at most a sixth of the largest second difference (exact for quadratics), and the distance to what is flat
/// is largest in a corner. The grid is refined while the bound is beyond the tolerance and a point may be within it.
/// @param tolerance  mm: the bound need not be tight below it, and beyond it only says so
double triangle_bound(const Adaptor3d_Surface& surface, const FaceTriangle& triangle, double tolerance,
                      Correspondence correspondence);

} // namespace fettle::cad
