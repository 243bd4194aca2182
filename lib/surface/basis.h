#pragma once

#include <Eigen/Core>

namespace fettle {

/// B-spline basis functions of one direction that do not vanish at a place.
struct Basis {
    Eigen::Index first = 0;     ///< control point that value[0] belongs to
    Eigen::VectorXd value;      ///< degree + 1
    Eigen::VectorXd derivative; ///< degree + 1
};

/// @param knots  ascending; control points + degree + 1 of them
/// @param t  within the domain, from knots[degree] to the (degree + 1)-th knot from the end, which belong to it
Basis basis(const Eigen::VectorXd& knots, int degree, double t);

/// The order-th derivative of the same functions at t.
Eigen::VectorXd basis_derivative(const Eigen::VectorXd& knots, int degree, double t, int order);

} // namespace fettle
