#pragma once

#include "fit/spline_prior.h"
#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle::fit {

/// Control heights of the difference between a round surface and the quadratic with the same curvatures. A sphere or
/// cylinder of curvature κ about its apex is
///     z = Q · 2 / (1 + √(1 - |∇Q|²)),   Q = ∓ κ r²/2 its quadratic part,
/// exactly; for other quadratic forms this formula gives a surface that is round in both principal directions.
/// Zero if the slope of Q exceeds kMaxRoundSlope at a touch, since such a surface is not round.
/// @param quadratic  coefficients of 1, u, v, u², uv, v² (SplinePrior)   @param uv  2xN, coordinates of the touches
Eigen::VectorXd round_part(const surface::Bspline& grid, const SplinePrior& prior,
                           const Eigen::Matrix<double, 6, 1>& quadratic, const Eigen::Matrix2Xd& uv);

/// 43°: spheres are certainly touched on flanks up to this slope, and end at 90°.
inline constexpr double kMaxRoundSlope = 0.94;

} // namespace fettle::fit
