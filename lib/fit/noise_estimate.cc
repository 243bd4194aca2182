#include "fit/noise_estimate.h"

#include "core/error.h"
#include "core/text.h"
#include "fit/family.h"
#include "fit/trimmed_touches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace fettle {

namespace {

struct Estimate {
    double sigma = 0; ///< mm
    double freedom = 0;
};

/// Standard deviation of the three quarters of the touches that lie nearest to a quadratic, as if they were all.
Estimate start(const FitInput& input)
{
    // Of normal errors cut at their quartiles' 1.15 σ: 1 / √(1 - 2 · 1.15 φ(1.15) / 0.75).
    constexpr double kTrimmed = 1.65;
    const Surface surface = begin_surface(input, "plane", kSampleRoles, 3);
    const Touched touched = touched_of(surface, input.job);
    const Columns kept = trimmed_touches(touched);
    for (const char* name : {"quadratic", "plane"}) {
        const std::optional<FamilySolution> solution = solve_family(name, touched, kept);
        if (!solution) continue;
        const auto freedom = static_cast<double>(kept.size()) - static_cast<double>(solution->gradients.rows());
        const Eigen::Matrix3Xd xyz = touched.xyz(Eigen::all, kept);
        const Eigen::VectorXd residuals = xyz.row(2).transpose() - heights(solution->shape, xyz.topRows(2));
        if (freedom > 0) return {kTrimmed * std::sqrt(residuals.squaredNorm() / freedom), freedom};
    }
    return {surface.touch_sigma, 1};
}

/// Σ of the squared residuals of the touches that are no slips.
double squares(const Fit& fit)
{
    double sum = fit.residuals.squaredNorm();
    for (const Eigen::Index slip : fit.surface.gross_errors) sum -= fit.residuals[slip] * fit.residuals[slip];
    return std::max(sum, 0.0);
}

} // namespace

Fit fit_with_estimated_noise(const FitInput& input, const std::string& method,
                             Fit (*fit_by)(const FitInput&, const std::string& method))
{
    constexpr double kLeastFreedom = 3; // Student's t has no variance below, next to none left to test
    constexpr double kSettled = 1e-3;   // of s, which scatters by far more
    constexpr int kMostRounds = 50;
    // Touches are stored in F4, which rounds by so much.
    const double least = 6e-8 * input.xyz.array().isNaN().select(0, input.xyz.array().abs()).maxCoeff();
    FitInput known = input;
    auto [sigma, freedom] = start(input);
    Fit fit;
    bool settled = false;
    for (int round = 0; round < kMostRounds && !settled; ++round) {
        sigma = std::max(sigma, least);
        known.job.probe.accuracy *= sigma / touch_sigma(known.job.probe);
        known.noise_freedom = freedom;
        fit = fit_by(known, method);
        freedom = fit.freedom - static_cast<double>(fit.surface.gross_errors.size());
        if (!(freedom >= kLeastFreedom))
            throw InputError(input.source, "a " + method + " fit leaves " + to_short_text(std::max(freedom, 0.0)) +
                                               " degrees of freedom, too few to tell the noise of the touches (3)");
        const double next = std::sqrt(squares(fit) / freedom);
        settled = std::abs(next - sigma) <= kSettled * sigma || next <= least;
        sigma = next;
    }
    const double widening = freedom / (freedom - 2);
    fit.surface.covariance *= widening;
    for (Alternative& other : fit.surface.alternatives) other.covariance *= widening;
    fit.surface.touch_freedom = freedom;
    fit.surface.goodness = std::numeric_limits<double>::quiet_NaN(); // they agree by construction
    fit.converged = fit.converged && settled;
    return fit;
}

} // namespace fettle
