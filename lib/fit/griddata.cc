#include "fit/griddata.h"

#include "core/error.h"
#include "fit/estimated.h"
#include "job/boundary.h"
#include "surface/griddata.h"

#include <cmath>

namespace fettle::fit {

namespace {

/// Half the mean distance of neighbours of points spread evenly over their hull, mm.
double default_spacing(const Eigen::Matrix2Xd& points)
{
    return std::sqrt(job::area(job::convex_hull(points)) / points.cols()) / 2;
}

} // namespace

Fit fit_griddata(const FitInput& input)
{
    constexpr int kMinPoints = 3;
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
