#include "fit/sphere.h"

#include "fit/round_start.h"
#include "surface/shapes.h"

#include <cmath>

namespace fettle {

namespace {

/// The same sphere about the point over xy, where it is best conditioned.
Sphere about(const Sphere& sphere, const Eigen::Vector2d& xy)
{
    const double z = height(sphere, xy);
    if (std::isnan(z)) return sphere;
    const Eigen::Vector2d z_xy = slope(sphere, xy);
    return {{xy.x(), xy.y(), z}, Eigen::Vector3d(-z_xy.x(), -z_xy.y(), 1).normalized(), sphere.curvature};
}

} // namespace

Fit fit_sphere(const FitInput& input)
{
    Surface surface = begin_surface(input, "sphere", kSampleRoles, 4);
    const RoundFrame frame = start_frame(surface.touches, input.job.theta, input.source);
    const double width = input.job.probe.accuracy;
    const RoundSolution solution =
        solve_sphere(frame, surface.touches, start_curvature(frame, surface.touches, true), width);
    const Eigen::VectorXd& p = solution.parameters;
    const Sphere sphere{frame.point + p[0] * frame.axes.col(2),
                        frame.axes * Eigen::Vector3d(p[2], p[1], 1).normalized(), p[3]};
    surface.shape = about(sphere, surface.touches.topRows(2).rowwise().mean());
    const Eigen::VectorXd weight = round_weights(surface, width, input.source);
    surface.covariance = round_covariance(surface, weight, {}, input.source);
    const double freedom = static_cast<double>(surface.touches.cols() - p.size());
    return finish_fit(std::move(surface), freedom, solution.converged, solution.iterations);
}

} // namespace fettle
