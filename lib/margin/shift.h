#pragma once

#include "job/job.h"
#include "margin/field_draws.h"
#include "surface/surface.h"

#include <cstdint>
#include <string>

namespace fettle::margin {

/// Predicts the error band of a surface inside B, and the shift that keeps the grinding above the true surface, from
/// the covariance of the fit. Height fields are drawn from it over a grid that covers B and its edge; with probability
/// `confidence` the true surface is
///   nowhere in B above the surface raised by `shift`, and
///   within an error band (Wang 2007, eq. 4-1) of at most `band`.
/// The prediction accounts for touch errors and for the prior of the fit, not for a wrong model such as a plane fitted
/// to a curved surface; the goodness of fit tests for that.
/// @param scan  of the metal around the anomaly (heights_around_anomaly); it says how large the surface's waves are
/// @param confidence  inside (0, 1)   @param source  the surface's name in messages
/// @throws InputError if the surface has no covariance, or only that of an interpolant (surface::has_sigma), or does
/// not
///         cover B
surface::Prediction predict_by_posterior(const surface::Surface& surface, const job::Job& job, double confidence,
                                         std::uint64_t seed, const std::string& source = "surface",
                                         Tails tails = Tails::student, const Eigen::Matrix3Xd& scan = {});

/// @throws InputError if the predicted shift or band exceeds the length of B, or is none: the touches, on a line or far
///         beside B, do not determine the surface
void check_determined(const surface::Prediction& prediction, const job::Job& job, const std::string& source);

/// The shift of a plane, which Wang's experiment does not cover.
enum class PlaneShift {
    worst_case, ///< each touch has an error of the probe's accuracy, in its worst direction
    accuracy,   ///< the probe's accuracy (Wang 2007, 4.5): the worst case of touches that share one error
};

/// Predicts both by Wang's regressions over his factorial experiment (2007, 4.5), from the touches' equivalent
/// curvature and variance, the area of B, and the farthest touch's distance from B. Where a regression falls below the
/// probe's accuracy, the accuracy is taken instead (`clamped`). There is none for planes: see PlaneShift.
/// @throws InputError if the touches do not determine the curvature
surface::Prediction predict_by_regression(const surface::Surface& surface, const job::Job& job,
                                          const std::string& source = "surface",
                                          PlaneShift plane_shift = PlaneShift::worst_case);

} // namespace fettle::margin
