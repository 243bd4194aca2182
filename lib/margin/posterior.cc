#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/quantiles.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/field_draws.h"
#include "margin/shift.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::margin {

namespace {

// Grid cells along the longer side of B. Touches are several cells apart, so a finer grid changes the extremes by less
// than the scatter of the draws.
constexpr int kAnomalyCells = 16;
constexpr int kDraws = 8192; // the 99 % quantile of so many has a relative standard deviation of about 1 %

/// A free-form surface whose family the job does not state may have waves about it. A fit to a scan, which has no
/// goodness of fit, follows its waves.
/// @throws InputError if a scan is to say how large the waves are of a surface that has none
UnseenWaves possible_waves(const surface::Surface& surface, const job::Job& job, Tails tails, bool is_scan_given,
                           const std::string& source)
{
    const bool is_of_touches = job.surface == job::SurfaceType::freeform && std::isfinite(surface.goodness);
    if (is_scan_given && !is_of_touches)
        throw core::InputError(source,
                               "is no free-form surface fitted to touches with one to spare, so no waves about it "
                               "are predicted from a scan");
    const bool may_wave = tails == Tails::student && is_of_touches && (is_scan_given || !surface.alternatives.empty());
    return may_wave ? UnseenWaves::possible : UnseenWaves::none;
}

/// @throws InputError if the most probable shape is not defined all over B
void check_coverage(const surface::Surface& surface, const Eigen::Matrix2Xd& grid, const units::Units& units,
                    const std::string& source)
{
    const Eigen::MatrixXd gradients = surface::height_gradients(surface.shape, grid);
    for (Eigen::Index i = 0; i < grid.cols(); ++i)
        if (!gradients.col(i).allFinite())
            throw core::InputError(source, "the surface does not cover the anomaly: it is not defined at " +
                                               job::point_text(grid.col(i), units));
}

} // namespace

void check_determined(const surface::Prediction& prediction, const job::Job& job, const std::string& source)
{
    const double length = geometry::bounding_box(job.anomaly.topRows<2>()).sizes().norm();
    const double largest = std::max(prediction.shift, prediction.band);
    if (largest <= length) return; // false for NaN
    throw core::InputError(
        source, "the touches do not determine the surface beneath the anomaly: its predicted error, " +
                    core::to_short_text(largest / job.units.mm()) + " " + units::to_string(job.units.length) +
                    ", exceeds the anomaly's length, " + core::to_short_text(length / job.units.mm()));
}

surface::Prediction predict_by_posterior(const surface::Surface& surface, const job::Job& job, double confidence,
                                         std::uint64_t seed, const std::string& source, Tails tails,
                                         const Eigen::Matrix3Xd& scan)
{
    if (!surface::has_sigma(surface) && !surface::has_touch_noise_only(surface))
        throw core::InputError(source,
                               "the surface has no covariance, so its error cannot be predicted; use the method wang");
    const Eigen::Matrix2Xd grid = anomaly_grid(job, kAnomalyCells);
    check_coverage(surface, grid, job.units, source);
    if (surface::has_touch_noise_only(surface))
        throw core::InputError(source, "the covariance of an interpolant (" + surface.method +
                                           ") holds the touches' noise, not what it misses between them, so its error "
                                           "cannot be predicted; use the method wang");
    std::vector<double> shifts, bands;
    visit_fields(surface, grid, kDraws, seed, tails, possible_waves(surface, job, tails, scan.cols() > 0, source), scan,
                 [&](const Eigen::VectorXd& field) {
                     shifts.push_back(field.maxCoeff()); // the fitted surface's error is the negative field
                     bands.push_back(error_band(field));
                 });
    // The quantiles of the band and the shift at this share of the draws.
    const auto rank = static_cast<std::size_t>(std::ceil(confidence * bands.size())) - 1;
    return {"posterior", confidence, geometry::nth_smallest(bands, rank), geometry::nth_smallest(shifts, rank), false};
}

} // namespace fettle::margin
