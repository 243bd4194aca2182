#include "fit/noise_estimate.h"

#include "core/error.h"
#include "core/text.h"
#include "fit/family.h"
#include "fit/trimmed_touches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace fettle::fit {

namespace {

struct NoiseEstimate {
    double sigma = 0; ///< mm
    double freedom = 0;
};

/// Least trimmed squares: the standard deviation of the three quarters of the touches that lie nearest to a quadratic,
/// corrected for trimming.
NoiseEstimate initial_estimate(const FitInput& input)
{
    // The standard deviation of normal errors over that of the three quarters within 1.15 σ,
    // 1 / √(1 - 2 · 1.15 φ(1.15) / 0.75).
    constexpr double kTrimmingFactor = 1.65;
    const surface::Surface surface = begin_surface(input, "plane", kSampleRoles, 3);
    const TouchSet touches = make_touch_set(surface, input.job);
    const TouchIndices kept = trimmed_touches(touches);
    for (const char* name : {"quadratic", "plane"}) {
        const std::optional<FamilySolution> solution = solve_family(name, touches, kept);
        if (!solution) continue;
        const double freedom = static_cast<Eigen::Index>(kept.size()) - solution->gradients.rows();
        const Eigen::Matrix3Xd xyz = touches.xyz(Eigen::all, kept);
        const Eigen::VectorXd residuals = xyz.row(2).transpose() - surface::heights(solution->shape, xyz.topRows(2));
        if (freedom > 0) return {kTrimmingFactor * std::sqrt(residuals.squaredNorm() / freedom), freedom};
    }
    return {surface.touch_sigma, 1};
}

/// Σ r² of the inliers, mm².
double inlier_square_sum(const Fit& fit)
{
    double sum = fit.residuals.squaredNorm();
    for (const Eigen::Index i : fit.surface.outliers) sum -= fit.residuals[i] * fit.residuals[i];
    return std::max(sum, 0.0);
}

} // namespace

Fit fit_with_estimated_noise(const FitInput& input, const std::string& method,
                             Fit (*fit_by)(const FitInput&, const std::string& method))
{
    constexpr double kMinFreedom = 3;                // Student's t with 2 has no variance
    constexpr double kRelativeSigmaTolerance = 1e-3; // far below the scatter of s
    constexpr int kMaxIterations = 50;
    // Single-precision files round touches by this much.
    const double min_sigma = 6e-8 * input.xyz.array().isNaN().select(0, input.xyz.array().abs()).maxCoeff();
    FitInput known = input;
    auto [sigma, freedom] = initial_estimate(input);
    Fit fit;
    bool converged = false;
    for (int i = 0; i < kMaxIterations && !converged; ++i) {
        sigma = std::max(sigma, min_sigma);
        known.job.probe.accuracy *= sigma / touch_sigma(known.job.probe);
        known.noise_freedom = freedom;
        fit = fit_by(known, method);
        freedom = fit.freedom - fit.surface.outliers.size();
        if (!(freedom >= kMinFreedom))
            throw core::InputError(
                input.source, "a " + method + " fit leaves " + core::to_short_text(std::max(freedom, 0.0)) +
                                  " degrees of freedom, too few to estimate the noise of the touches (at least 3)");
        const double next = std::sqrt(inlier_square_sum(fit) / freedom);
        converged = std::abs(next - sigma) <= kRelativeSigmaTolerance * sigma || next <= min_sigma;
        sigma = next;
    }
    const double inflation = freedom / (freedom - 2);
    fit.surface.covariance *= inflation;
    for (surface::Alternative& other : fit.surface.alternatives) other.covariance *= inflation;
    fit.surface.touch_sigma_dof = freedom;
    fit.surface.goodness = std::numeric_limits<double>::quiet_NaN(); // residuals and noise agree by construction
    fit.converged = fit.converged && converged;
    return fit;
}

} // namespace fettle::fit
