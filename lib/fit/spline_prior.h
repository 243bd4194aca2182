#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle::fit {

/// Prior of a height field: small values of its rotation-invariant third-derivative energy
///     E(f) = ∫∫ f_uuu² + 3 f_uuv² + 3 f_uvv² + f_vvv²  du dv = cᵀ K c
/// (the order-3 thin-plate energy of Duchon 1977), whose null space are the quadratics. As a random field: f = q + g, q
/// quadratic, and the control heights of g have the covariance τ² K⁺ (Wahba 1990, 1.5).
struct SplinePrior {
    Eigen::MatrixXd quadratics;     ///< control heights of 1, u, v, u², uv, v²; u, v from the middle over `half`
    Eigen::Vector2d middle;         ///< centre of the rectangle relative to its corner, in its own axes, mm
    double half = 1;                ///< half the longer side, mm
    Eigen::MatrixXd pseudo_inverse; ///< K⁺
};

/// @param grid  its heights are not read
SplinePrior spline_prior(const surface::Bspline& grid);

} // namespace fettle::fit
