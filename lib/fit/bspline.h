#pragma once

#include "fit/fit.h"

namespace fettle {

/// The default for free-form surfaces: a tensor-product cubic B-spline height field on a grid aligned with W that
/// covers B and the touches. It minimises, with Ceres,
///     Σ ρ((z_i - f(x_i, y_i)) / σ)  +  E(g) / τ²  +  |D²q|² / κ²  +  (c - 1)² / s²,    f = q + c p + g
/// σ is the touch's standard deviation, ρ Huber's loss with the width of the probe's accuracy. q is a quadratic, p
/// turns it into a round surface (round_part.h), g is the rest, E its third-derivative energy (spline_prior.h), τ the
/// amplitude that the touches leave to be expected (evidence.h). Touches that are better explained as slips are left
/// out of the sum; the goodness still counts them. κ is the size of the touched curvature, or that of slopes that
/// change by 1 over the touched length; it only speaks where the touches do not, such as for the twist between two
/// crossing lines. Quadratics, spheres and cylinders are reproduced when the touches are exact. The covariance is that
/// of the control heights given the touches.
/// More than kMostExactTouches (dense.h) take long: fit_dense() is for those.
/// @throws InputError for fewer than 6 touches, or touches on a line
Fit fit_bspline(const FitInput& input);

/// The grid: over B and the touches, with a cell around them; heights 0.
Bspline spline_grid(const FitInput& input, const Eigen::Matrix3Xd& touches);

/// τ above for touches none of which slipped. @param sigma  of a touch, mm
double field_amplitude(const FitInput& input, double sigma);

} // namespace fettle
