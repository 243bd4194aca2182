#include "fit/fit.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "surface/shapes.h"

#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::fit {

double touch_sigma(const job::Probe& probe)
{
    constexpr double kTwoSided99 = 2.5758293035489; // 99.5 % quantile of N(0, 1)
    return probe.accuracy / kTwoSided99;
}

double huber_weight(double residual, double width)
{
    const double size = std::abs(residual);
    return size <= width ? 1 : width / size;
}

bool is_used_role(double role, const std::vector<int>& wanted_roles, bool use_boundary)
{
    return (role == 0 && use_boundary) ||
           std::find(wanted_roles.begin(), wanted_roles.end(), role) != wanted_roles.end();
}

double chi2_p_value(double chi2, double freedom)
{
    return freedom > 0 && std::isfinite(chi2) ? boost::math::gamma_q(freedom / 2, chi2 / 2) : 1;
}

std::vector<Eigen::Index> usable_points(const FitInput& input, const std::vector<int>& wanted_roles)
{
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < input.xyz.cols(); ++i)
        if (is_used_role(input.roles[i], wanted_roles, input.use_boundary) && input.xyz.col(i).allFinite())
            used.push_back(i);
    return used;
}

void add_boundary_touches(FitInput& input)
{
    input.use_boundary = true;
    if ((input.roles.array() == 0).any()) return;
    std::vector<Eigen::Index> known;
    for (Eigen::Index i = 0; i < input.job.anomaly.cols(); ++i)
        if (std::isfinite(input.job.anomaly(2, i))) known.push_back(i);
    if (known.empty())
        throw core::InputError(input.source, "no point of role 0, and no boundary point of the job has a z");
    const Eigen::Index before = input.xyz.cols(), added = known.size();
    input.xyz.conservativeResize(3, before + added);
    input.xyz.rightCols(added) = input.job.anomaly(Eigen::all, known);
    input.roles.conservativeResize(before + added);
    input.roles.tail(added).setZero();
    if (input.curves.size() == 0) return;
    input.curves.conservativeResize(before + added);
    input.curves.tail(added).setConstant(-1); // on no line
}

void check_not_collinear(const FitInput& input, const Eigen::Matrix3Xd& touches)
{
    // Single-precision files round coordinates by 6e-8 of their size, so smaller relative spreads are roundoff.
    constexpr double kRoundingTolerance = 1e-6;
    const Eigen::Matrix2Xd d = touches.topRows(2).colwise() - touches.topRows(2).rowwise().mean().eval();
    const core::SymmetricEigen<2> spread = core::symmetric_eigen<2>(d * d.transpose());
    const double min_spread = std::sqrt(std::max(spread.values[0], 0.0) / d.cols());
    const double max_spread = std::sqrt(spread.values[1] / d.cols());
    // While the noise is estimated, the accuracy is a guess and may exceed the part.
    const double accuracy = input.estimate_noise ? 0 : input.job.probe.accuracy;
    if (min_spread <= std::max(accuracy, kRoundingTolerance * max_spread))
        throw core::InputError(input.source, "touches lie on one line in x and y");
}

surface::Surface begin_surface(const FitInput& input, const std::string& method, const std::vector<int>& wanted_roles,
                               int min_touches)
{
    const std::vector<Eigen::Index> used = usable_points(input, wanted_roles);
    if (static_cast<int>(used.size()) < min_touches)
        throw core::InputError(input.source, "a " + method + " fit needs at least " + std::to_string(min_touches) +
                                                 " touches, got " + std::to_string(used.size()) + " of " +
                                                 std::to_string(input.xyz.cols()) + " points that it may use");
    surface::Surface surface;
    surface.units = input.job.units;
    surface.method = method;
    surface.touch_sigma = touch_sigma(input.job.probe);
    surface.touch_sigma_dof = input.noise_freedom;
    surface.touches = input.xyz(Eigen::all, used);
    surface.roles = input.roles(used);
    surface.ignored = static_cast<int>(input.xyz.cols() - surface.touches.cols());
    if (method != "plane") check_not_collinear(input, surface.touches); // a plane may stand steep: fit_plane()
    return surface;
}

Fit finish_fit(surface::Surface surface, double freedom, bool converged, int iterations)
{
    // Fewer degrees of freedom than this are the rounding error of a trace: there is nothing to test.
    constexpr double kMinFreedom = 1e-3;
    Fit fit;
    fit.freedom = freedom;
    fit.converged = converged;
    fit.iterations = iterations;
    fit.residuals = surface.touches.row(2).transpose() - surface::heights(surface, surface.touches.topRows(2));
    surface.rms = std::sqrt(fit.residuals.squaredNorm() / fit.residuals.size());
    surface.goodness = std::numeric_limits<double>::quiet_NaN();
    if (freedom > kMinFreedom && surface.touch_sigma > 0) {
        const double chi2 = fit.residuals.squaredNorm() / (surface.touch_sigma * surface.touch_sigma);
        if (std::isfinite(chi2)) surface.goodness = chi2_p_value(chi2, freedom);
    }
    fit.surface = std::move(surface);
    return fit;
}

} // namespace fettle::fit
