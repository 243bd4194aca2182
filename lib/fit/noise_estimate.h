#pragma once

#include "fit/fit.h"

#include <string>

namespace fettle::fit {

/// Fits by the method of a name and estimates the standard deviation s of a touch: s² is the inliers' sum of squared
/// residuals over its degrees of freedom ν. The outliers and the weights of families depend on s, so the fit is
/// repeated until s converges, starting with the estimate of least trimmed squares.
///
/// s² is distributed about the true variance as χ²_ν / ν, so that a height's error over its standard deviation has
/// Student's t distribution: the covariances are multiplied by its variance, ν / (ν - 2), and the surface carries ν
/// (touch_freedom). Model errors count as noise.
/// @param fit_by  fits by the method for a given job.probe.accuracy
/// @throws InputError for fewer than 3 degrees of freedom
Fit fit_with_estimated_noise(const FitInput& input, const std::string& method,
                             Fit (*fit_by)(const FitInput&, const std::string& method));

} // namespace fettle::fit
