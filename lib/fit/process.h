#pragma once

#include "fit/family.h"

namespace fettle::fit {

/// Gaussian process regression with a quadratic trend (a plane, if the touches do not determine a quadratic): z = f + g
/// + e with a flat prior of f, and g a Gaussian process with the covariance τ² exp(-|Δ|²/2ℓ²) or Matérn's with ν = 5/2
/// (universal kriging: Cressie 1993, 3.4; Rasmussen and Williams 2006, 2.7 and 4.2). The kernel, τ and ℓ are integrated
/// out over a grid of values by their restricted likelihood (Patterson and Thompson 1971), with uniform priors in ln τ
/// and ln ℓ. The result is one height field on a bicubic B-spline grid, with the mean and the covariance of this
/// mixture. A richer trend than a quadratic would take over what the process models better.
/// @param grid  over B and the touches, the finest to be used; its heights are not read. The cells are made as long as
///              the correlation lengths allow.
/// @return  nothing for fewer touches than two more than the trend's parameters, or touches on a line
std::optional<FitCandidate> fit_gaussian_process(const TouchSet& touches, const surface::Bspline& grid);

} // namespace fettle::fit
