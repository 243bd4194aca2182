#include "fit/bspline_wang.h"

#include "core/error.h"
#include "fit/estimated.h"
#include "surface/tensor_bspline.h"

namespace fettle {

Fit fit_bspline_wang(const FitInput& input)
{
    constexpr int kLeastPoints = 4;
    Surface surface = begin_surface(input, "bspline-wang", kSampleAndEstimatedRoles, kLeastPoints);
    try {
        const TensorBsplineSystem system(surface.touches.topRows<2>(), input.job.theta);
        surface.shape = system.surface(surface.touches.row(2));
        const Eigen::MatrixXd follow =
            system.control_heights(dependence(input.job, surface.touches, surface.roles, used_curves(input)));
        surface.covariance = surface.touch_sigma * surface.touch_sigma * follow * follow.transpose();
    } catch (const InputError& error) {
        throw InputError(input.source, error.what());
    }
    return finish_fit(std::move(surface), 0, true, 0);
}

} // namespace fettle
