#pragma once

#include "surface/surface.h"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include <string>

namespace fettle::surface {

/// Wang's modified tensor B-spline through scattered points (2007, 4.3): one equation per point and about as many
/// control heights as points, on a grid in the ratio of the sides of the points' rectangle. The parameters of a point
/// are its coordinates along the axes (the chord lengths of its projection), so that the surface is a height field; the
/// knots are averages of them (Piegl and Tiller 1997, 9.2.1). Degree 3, or less in a direction with 2 or 3 control
/// heights.
///
/// Scattered points often make this system nearly singular. Touches on two lines each way always do, because the
/// product of the distances to the lines vanishes at all of them. Parameters that the points do not determine follow
/// from the minimum of the bending energy ∫ z_uu² + 2 z_uv² + z_vv²; the others are not affected by it.
class TensorBsplineSystem {
  public:
    /// @param xy  2xN, M, mm   @param angle  from X_m to u, rad
    /// @throws InputError for fewer than 4 or more than 2000 distinct points, for collinear points or NaN; the message
    ///         has no file name
    TensorBsplineSystem(const Eigen::Matrix2Xd& xy, double angle);

    /// Control heights of several fields. @param z  N x C, one column per field, mm   @return one column per field
    Eigen::MatrixXd control_heights(const Eigen::MatrixXd& z) const;
    /// The surface through the points. @param z  N, mm
    TensorBspline surface(const Eigen::VectorXd& z) const;

  private:
    TensorBspline zero_surface_; ///< the knots, with all heights 0
    Eigen::SparseMatrix<double> equations_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

/// Checks knots against a number of control heights. @return  the problem for a message; empty if there is none
std::string knot_problem(const Eigen::VectorXd& knots, Eigen::Index control);

// See surface/shapes.h.
double height(const TensorBspline& bspline, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const TensorBspline& bspline, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const TensorBspline& bspline, const Eigen::Vector2d& xy);

} // namespace fettle::surface
