#include "fit/fit.h"

#include "core/error.h"
#include "surface/shapes.h"

#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

double touch_sigma(const Probe& probe)
{
    constexpr double kTwoSided99 = 2.5758293035489; // quantile 0.995 of the normal distribution
    return probe.accuracy / kTwoSided99;
}

double huber_weight(double residual, double width)
{
    const double size = std::abs(residual);
    return size <= width ? 1 : width / size;
}

std::vector<Eigen::Index> usable_points(const FitInput& input, const std::vector<int>& wanted_roles)
{
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < input.xyz.cols(); ++i) {
        const int role = input.roles[i];
        const bool wanted = (role == 0 && input.use_boundary) ||
                            std::find(wanted_roles.begin(), wanted_roles.end(), role) != wanted_roles.end();
        if (wanted && input.xyz.col(i).allFinite()) used.push_back(i);
    }
    return used;
}

void take_boundary(FitInput& input)
{
    input.use_boundary = true;
    if ((input.roles.array() == 0).any()) return;
    std::vector<Eigen::Index> known;
    for (Eigen::Index i = 0; i < input.job.anomaly.cols(); ++i)
        if (std::isfinite(input.job.anomaly(2, i))) known.push_back(i);
    if (known.empty()) throw InputError(input.source, "no point of role 0, and no boundary point of the job has a z");
    const Eigen::Index before = input.xyz.cols(), added = static_cast<Eigen::Index>(known.size());
    input.xyz.conservativeResize(3, before + added);
    input.xyz.rightCols(added) = input.job.anomaly(Eigen::all, known);
    input.roles.conservativeResize(before + added);
    input.roles.tail(added).setZero();
    if (input.curves.size() == 0) return;
    input.curves.conservativeResize(before + added);
    input.curves.tail(added).setConstant(-1); // of no line
}

Surface begin_surface(const FitInput& input, const std::string& method, const std::vector<int>& wanted_roles, int least)
{
    const std::vector<Eigen::Index> used = usable_points(input, wanted_roles);
    if (static_cast<int>(used.size()) < least)
        throw InputError(input.source, "a " + method + " fit needs at least " + std::to_string(least) +
                                           " touches, got " + std::to_string(used.size()) + " of " +
                                           std::to_string(input.xyz.cols()) + " points that it may use");
    Surface surface;
    surface.units = input.job.units;
    surface.method = method;
    surface.touch_sigma = touch_sigma(input.job.probe);
    surface.touch_freedom = input.noise_freedom;
    surface.touches = input.xyz(Eigen::all, used);
    surface.roles = input.roles(used);
    surface.ignored = static_cast<int>(input.xyz.cols()) - static_cast<int>(used.size());
    return surface;
}

Fit finish_fit(Surface surface, double freedom, bool converged, int iterations)
{
    // Fewer degrees of freedom than this are rounding of a trace: nothing is left to test.
    constexpr double kLeastFreedom = 1e-3;
    Fit fit;
    fit.freedom = freedom;
    fit.converged = converged;
    fit.iterations = iterations;
    fit.residuals = surface.touches.row(2).transpose() - heights(surface, surface.touches.topRows(2));
    surface.rms = std::sqrt(fit.residuals.squaredNorm() / static_cast<double>(fit.residuals.size()));
    surface.goodness = std::numeric_limits<double>::quiet_NaN();
    if (freedom > kLeastFreedom && surface.touch_sigma > 0) {
        const double chi2 = fit.residuals.squaredNorm() / (surface.touch_sigma * surface.touch_sigma);
        if (std::isfinite(chi2)) surface.goodness = boost::math::gamma_q(freedom / 2, chi2 / 2);
    }
    fit.surface = std::move(surface);
    return fit;
}

} // namespace fettle
