#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle {

/// What is expected of a height field before it is touched: its rotation-invariant third-derivative energy
///     E(f) = ∫∫ f_uuu² + 3 f_uuv² + 3 f_uvv² + f_vvv²  du dv = cᵀ K c
/// is small (the order-3 thin-plate energy of Duchon 1977), while quadratics, whose energy is 0, are free. As a random
/// field: f = q + g, q quadratic, and the control heights of g have the covariance τ² K⁺ (Wahba 1990, 1.5).
struct SplinePrior {
    Eigen::MatrixXd quadratics;     ///< control heights of 1, u, v, u², uv, v²; u, v from the middle over `half`
    Eigen::Vector2d middle;         ///< of the rectangle, in its own axes, from its corner, mm
    double half = 1;                ///< half the longer side, mm
    Eigen::MatrixXd pseudo_inverse; ///< K⁺
};

/// @param grid  its heights are not read
SplinePrior spline_prior(const Bspline& grid);

/// ∫∫ of the squares above, exactly, by Gauss's rule on each cell.
Eigen::MatrixXd third_derivative_energy(const Bspline& grid);

} // namespace fettle
