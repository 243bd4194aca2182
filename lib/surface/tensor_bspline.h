#pragma once

#include "surface/surface.h"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include <string>

namespace fettle {

/// Wang's modified tensor B-spline through scattered points (2007, 4.3): one equation for each point, as many unknown
/// control heights as there are points, as nearly as a grid of them allows, in the ratio of the sides of the points'
/// rectangle. The parameters of a point are its places along the axes (the chord lengths of its projection), so that
/// the surface is a height; the knots are their averages (Piegl and Tiller 1997, 9.2.1). Cubic; a direction with 2 or 3
/// control heights is linear or quadratic.
///
/// Scattered points often leave this system nearly singular (touches on two lines each way always do: the product of
/// the distances to the lines vanishes at all of them). What the points leave open is taken from the least bending
/// energy ∫ z_uu² + 2 z_uv² + z_vv²; what they determine is not touched by it.
class TensorBsplineSystem {
  public:
    /// @param xy  2xN, M, mm   @param angle  from X_m to u, rad
    /// @throws InputError for fewer than 4 or more than 2000 different points, points on a line or not finite; the
    ///         message has no file name
    TensorBsplineSystem(const Eigen::Matrix2Xd& xy, double angle);

    /// @param z  N x C, one field a column   @return control heights x C, column-major in each
    Eigen::MatrixXd control_heights(const Eigen::MatrixXd& z) const;
    /// @param z  N, mm
    TensorBspline surface(const Eigen::VectorXd& z) const;

  private:
    TensorBspline flat_; ///< all heights 0
    Eigen::SparseMatrix<double> equations_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

/// What keeps knots from carrying so many control heights; empty: nothing.
std::string wrong_with_knots(const Eigen::VectorXd& knots, Eigen::Index control);

double height(const TensorBspline& bspline, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const TensorBspline& bspline, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const TensorBspline& bspline, const Eigen::Vector2d& xy);
Eigen::VectorXi parameter_powers(const TensorBspline& bspline);

} // namespace fettle
