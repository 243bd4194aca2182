#pragma once

#include "job/job.h"
#include "surface/surface.h"

#include <cstdint>
#include <string>

namespace fettle {

/// Predicts the error band of a surface inside B, and the shift that keeps the grinding above the true surface, from
/// the covariance of the fit. Height fields are drawn from it over a grid that covers B and its edge; with probability
/// `confidence` the true surface is
///   nowhere in B above the surface raised by `shift`, and
///   within an error band (Wang 2007, eq. 4-1) of at most `band`.
/// It knows the touch error and what the fit's own prior allows, not that a plane was fitted to what is none: that is
/// the goodness of fit's part.
/// @param confidence  inside (0, 1)   @param source  the surface's name in messages
/// @throws InputError if the surface has no covariance or does not cover B
Prediction predict_by_posterior(const Surface& surface, const Job& job, double confidence, std::uint64_t seed,
                                const std::string& source = "surface");

/// Predicts both by Wang's regressions over his factorial experiment (2007, 4.5), from the touches' equivalent
/// curvature and variance, the area of B, and the farthest touch's distance from B. Where a regression falls below the
/// probe's accuracy, that is taken instead (`clamped`). Planes: the worst case of touches that are all wrong by the
/// probe's accuracy.
/// @throws InputError if the touches do not determine the curvature
Prediction predict_by_regression(const Surface& surface, const Job& job, const std::string& source = "surface");

} // namespace fettle
