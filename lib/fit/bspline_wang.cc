#include "fit/bspline_wang.h"

#include "core/error.h"
#include "fit/estimated.h"
#include "surface/tensor_bspline.h"

namespace fettle::fit {

Fit fit_bspline_wang(const FitInput& input)
{
    constexpr int kMinPoints = 4;
    surface::Surface surface = begin_surface(input, "bspline-wang", kSampleAndEstimatedRoles, kMinPoints);
    try {
        const surface::TensorBsplineSystem system(surface.touches.topRows<2>(), input.job.theta);
        surface.shape = system.surface(surface.touches.row(2));
        const Eigen::MatrixXd jacobian = system.control_heights(touch_jacobian(input, surface));
        surface.covariance = surface.touch_sigma * surface.touch_sigma * jacobian * jacobian.transpose();
    } catch (const core::InputError& error) {
        throw core::InputError(input.source, error.what());
    }
    return finish_fit(std::move(surface), 0, true, 0);
}

} // namespace fettle::fit
