#pragma once

#include "fit/fit.h"

namespace fettle {

/// The default for free-form surfaces: a tensor-product cubic B-spline height field on a grid aligned with W that
/// covers B and the touches. It minimises, with Ceres,
///     Σ ρ((z_i - f(x_i, y_i)) / σ)  +  E(f) / τ²  +  |D²q|² / κ²
/// σ is the touch's standard deviation, ρ Huber's loss with the width of the probe's accuracy, E the third-derivative
/// energy (spline_prior.h), τ the amplitude that makes the touches most probable (evidence.h). κ only speaks where the
/// touches do not, such as for the twist between two crossing lines: slopes are expected to change by about 1 over the
/// touched length. The covariance is that of the control heights given the touches, (AᵀWA/σ² + K/τ² + …)⁻¹.
/// @throws InputError for fewer than 6 touches, or touches on a line
Fit fit_bspline(const FitInput& input);

} // namespace fettle
