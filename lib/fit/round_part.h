#pragma once

#include "fit/spline_prior.h"
#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle {

/// By how much the round surface with a quadratic's curvatures differs from it, as control heights. A sphere or
/// cylinder of curvature κ about its apex is
///     z = Q · 2 / (1 + √(1 - |∇Q|²)),   Q = ∓ κ r²/2 its quadratic part,
/// exactly; with other quadratic forms the same formula gives a surface that is round in both principal directions.
/// Zero if a touch lies where the slope of Q is more than kMostRoundSlope: such a surface is not round.
/// @param quadratic  coefficients of 1, u, v, u², uv, v² (SplinePrior)   @param uv  2xN, the touches, likewise
Eigen::VectorXd round_part(const Bspline& grid, const SplinePrior& prior, const Eigen::Matrix<double, 6, 1>& quadratic,
                           const Eigen::Matrix2Xd& uv);

/// 43°; the flank of a sphere up to there is touched without doubt, beyond 90° there is none.
inline constexpr double kMostRoundSlope = 0.94;

} // namespace fettle
