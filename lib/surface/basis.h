#pragma once

#include <Eigen/Core>

namespace fettle::surface {

/// The B-spline basis functions in one variable that do not vanish at a parameter t.
struct BasisFunctions {
    Eigen::Index first = 0;     ///< index of the control point of value[0]
    Eigen::VectorXd value;      ///< degree + 1
    Eigen::VectorXd derivative; ///< degree + 1
};

/// @param knots  ascending; control points + degree + 1 of them
/// @param t  within the domain, from knots[degree] to the (degree + 1)-th knot from the end, both included
BasisFunctions basis_functions(const Eigen::VectorXd& knots, int degree, double t);

/// Derivatives of order `order` of the same basis functions at t.
Eigen::VectorXd basis_derivative(const Eigen::VectorXd& knots, int degree, double t, int order);

/// The four uniform cubic basis functions over a unit cell, or their derivatives of order 1 to 3 (de Boor 1978, ch. X).
/// @param f  position in the cell, 0 to 1
inline Eigen::Vector4d uniform_cubic_basis(double f, int order = 0)
{
    const double g = 1 - f;
    switch (order) {
    case 0:
        return Eigen::Vector4d(g * g * g, 4 - 6 * f * f + 3 * f * f * f, 4 - 6 * g * g + 3 * g * g * g, f * f * f) / 6;
    case 1:
        return Eigen::Vector4d(-g * g, 3 * f * f - 4 * f, 4 * g - 3 * g * g, f * f) / 2;
    case 2:
        return {g, 3 * f - 2, 3 * g - 2, f};
    default:
        return {-1, 3, -3, 1};
    }
}

} // namespace fettle::surface
