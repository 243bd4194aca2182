#pragma once

#include "fit/fit.h"

#include <string>

namespace fettle {

/// Fits by a method's name with the standard deviation s of a touch estimated: s² is the sum of the squared residuals
/// over their degrees of freedom ν, of the touches that are no slips. As slips, and the weights of families, depend on
/// s itself, the fit is repeated until it agrees with what it began with; first with the least trimmed squares.
///
/// s² scatters about the true variance as χ²_ν / ν, so that a height's error over its standard deviation has Student's
/// t distribution: the covariances are widened by its variance, ν / (ν - 2), and the surface carries ν
/// (touch_freedom). What the method cannot follow counts as noise.
/// @param fit_by  fits by the method, with job.probe.accuracy known
/// @throws InputError for fewer than 3 degrees of freedom
Fit fit_with_estimated_noise(const FitInput& input, const std::string& method,
                             Fit (*fit_by)(const FitInput&, const std::string& method));

} // namespace fettle
