#include "fit/griddata.h"

#include "core/error.h"
#include "fit/estimated.h"
#include "job/boundary.h"
#include "surface/griddata.h"

#include <cmath>

namespace fettle {

namespace {

/// Half the mean distance of neighbours, if the points were spread evenly over their hull, mm.
double natural_spacing(const Eigen::Matrix2Xd& points)
{
    return std::sqrt(area(convex_hull(points)) / static_cast<double>(points.cols())) / 2;
}

} // namespace

Fit fit_griddata(const FitInput& input)
{
    constexpr int kLeastPoints = 3;
    Surface surface = begin_surface(input, "griddata", kSampleAndEstimatedRoles, kLeastPoints);
    const double spacing = input.spacing.value_or(natural_spacing(surface.touches.topRows<2>()));
    try {
        surface.shape = make_griddata(surface.touches, spacing, input.job.theta);
        const Eigen::MatrixXd follow = dependence(input.job, surface.touches, surface.roles, used_curves(input));
        surface.covariance = surface.touch_sigma * surface.touch_sigma * follow * follow.transpose();
    } catch (const InputError& error) {
        throw InputError(input.source, error.what());
    }
    return finish_fit(std::move(surface), 0, true, 0);
}

} // namespace fettle
