#include "fit/cylinder.h"

#include "core/error.h"
#include "fit/round_start.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {

namespace {

/// The same cylinder about the point over xy, where it is best conditioned.
Cylinder about(const Cylinder& cylinder, const Eigen::Vector2d& xy)
{
    const double z = height(cylinder, xy);
    if (std::isnan(z)) return cylinder;
    const Eigen::Vector2d z_xy = slope(cylinder, xy);
    const Eigen::Vector3d steepest(-z_xy.x(), -z_xy.y(), 1);
    // Perpendicular to the axis but for rounding.
    const Eigen::Vector3d normal = (steepest - steepest.dot(cylinder.axis) * cylinder.axis).normalized();
    return {{xy.x(), xy.y(), z}, normal, cylinder.axis, cylinder.curvature};
}

Cylinder cylinder_of(const RoundFrame& frame, const Eigen::VectorXd& p)
{
    const Eigen::Vector3d a = (frame.axes * Eigen::Vector3d(1, p[3], -p[2])).normalized();
    const Eigen::Vector3d up = frame.axes * Eigen::Vector3d(0, p[1], 1);
    return {frame.point + p[0] * frame.axes.col(2), (up - up.dot(a) * a).normalized(), a, p[4]};
}

} // namespace

Fit fit_cylinder(const FitInput& input)
{
    Surface surface = begin_surface(input, "cylinder", kSampleRoles, 5);
    const double width = input.job.probe.accuracy;
    constexpr int kDirections = 6; // a valley of the cost over the axis' direction is wider than 30 degrees
    RoundSolution best;
    best.cost = std::numeric_limits<double>::infinity();
    int iterations = 0;
    for (int i = 0; i < kDirections; ++i) {
        const double angle = input.job.theta + i * std::numbers::pi / kDirections;
        const RoundFrame frame = start_frame(surface.touches, angle, input.source);
        const RoundSolution solution =
            solve_cylinder(frame, surface.touches, start_curvature(frame, surface.touches, false), width);
        iterations += solution.iterations;
        const Cylinder cylinder = cylinder_of(frame, solution.parameters);
        if (solution.cost >= best.cost || cylinder.normal.z() <= 0) continue;
        best = solution;
        surface.shape = about(cylinder, surface.touches.topRows(2).rowwise().mean());
    }
    if (best.parameters.size() == 0) throw InputError(input.source, "no cylinder goes near the touches");
    const Eigen::VectorXd weight = round_weights(surface, width, input.source);
    constexpr Eigen::Index kTurn = 3; // of the axis, of which a plane knows nothing
    surface.covariance = round_covariance(surface, weight, {kTurn}, input.source);
    const double freedom = static_cast<double>(surface.touches.cols() - best.parameters.size());
    return finish_fit(std::move(surface), freedom, best.converged, iterations);
}

} // namespace fettle
