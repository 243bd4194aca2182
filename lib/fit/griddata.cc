#include "fit/griddata.h"

#include "core/error.h"
#include "fit/estimated.h"
#include "job/boundary.h"
#include "sampling/touch_plan.h"
#include "surface/griddata.h"

#include <cmath>
#include <utility>
#include <vector>

namespace fettle::fit {

namespace {

/// Half the mean distance of neighbours of points spread evenly over their hull, mm.
double default_spacing(const Eigen::Matrix2Xd& points)
{
    return std::sqrt(job::area(job::convex_hull(points)) / points.cols()) / 2;
}

/// The input with the measured points of the sampling boundary as touches on no line, except where there are touches.
FitInput with_sampling_boundary(FitInput input)
{
    const std::vector<Eigen::Index> used = usable_points(input, kSampleAndEstimatedRoles);
    std::vector<Eigen::Index> measured;
    for (const Eigen::Index i :
         sampling::untouched_sampling_points(input.job, input.xyz(Eigen::all, used).topRows<2>()))
        if (std::isfinite(input.job.sampling(2, i))) measured.push_back(i);
    const auto added = static_cast<Eigen::Index>(measured.size()), size = input.xyz.cols() + added;
    input.xyz.conservativeResize(3, size);
    input.xyz.rightCols(added) = input.job.sampling(Eigen::all, measured);
    input.roles.conservativeResize(size);
    input.roles.tail(added).setConstant(static_cast<int>(sampling::Role::near_sampling_boundary));
    if (input.curves.size() == 0) return input;
    input.curves.conservativeResize(size);
    input.curves.tail(added).setConstant(sampling::kNoLine);
    return input;
}

} // namespace

Fit fit_griddata(const FitInput& touched)
{
    constexpr int kMinPoints = 3;
    const FitInput input = with_sampling_boundary(touched);
    surface::Surface surface = begin_surface(input, "griddata", kSampleAndEstimatedRoles, kMinPoints);
    const double spacing = input.spacing.value_or(default_spacing(surface.touches.topRows<2>()));
    try {
        surface.shape = surface::make_griddata(surface.touches, spacing, input.job.theta);
        const Eigen::MatrixXd jacobian = touch_jacobian(input, surface);
        surface.covariance = surface.touch_sigma * surface.touch_sigma * jacobian * jacobian.transpose();
    } catch (const core::InputError& error) {
        throw core::InputError(input.source, error.what());
    }
    return finish_fit(std::move(surface), 0, true, 0);
}

} // namespace fettle::fit
