#include "core/constants.h"
#include "surface/quadratic.h"
#include "surface/revolution.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <cmath>

namespace fettle::surface {

namespace {

Torus torus_of(const Cone& cone) { return {cone.point, cone.normal, cone.axis, cone.curvature_around, cone.lean, 0}; }

/// The axes a, b, n of the torus's frame as columns.
Eigen::Matrix3d frame(const Torus& torus)
{
    Eigen::Matrix3d axes;
    axes << torus.axis, torus.normal.cross(torus.axis), torus.normal;
    return axes;
}

RevolutionParameters parameters(const Torus& torus)
{
    RevolutionParameters theta = RevolutionParameters::Zero();
    theta[kCurvatureAround] = torus.curvature_around;
    theta[kLean] = torus.lean;
    theta[kCurvatureAlong] = torus.curvature_along;
    return theta;
}

/// Vector from the torus's `point` to the surface over xy, in its frame: Newton's method along the vertical, started on
/// the osculating paraboloid. NaN where the surface is not reached or overhangs.
Eigen::Vector3d offset(const Torus& torus, const Eigen::Matrix3d& axes, const Eigen::Vector2d& xy)
{
    constexpr int kMaxIterations = 50;               // twice the number needed from a start on the far flank
    constexpr double kRelativeStepTolerance = 1e-13; // relative to the distance from the point: rounding
    const Eigen::Vector3d vertical = axes.row(2);
    const Eigen::Vector3d level =
        axes.transpose() * Eigen::Vector3d(xy.x() - torus.point.x(), xy.y() - torus.point.y(), 0);
    const double across = torus.curvature_around * std::cos(torus.lean);
    const auto half = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
        return (torus.curvature_along * p[0] * q[0] + across * p[1] * q[1]) / 2;
    };
    double z = increasing_root(half(vertical, vertical), vertical[2] + 2 * half(level, vertical),
                               half(level, level) + level[2]);
    if (std::isnan(z)) z = -level[2] / vertical[2];
    const Revolution surface = make_revolution(parameters(torus));
    for (int i = 0; i < kMaxIterations; ++i) {
        const Eigen::Vector3d d = level + z * vertical;
        const RevolutionDistance f = distance_with_gradients(surface, d);
        const double rise = f.gradient.dot(vertical);
        if (!(rise > 0)) return Eigen::Vector3d::Constant(core::kNaN);
        const double step = f.value / rise;
        z -= step;
        if (std::abs(step) <= kRelativeStepTolerance * d.norm()) return level + z * vertical;
    }
    return Eigen::Vector3d::Constant(core::kNaN);
}

} // namespace

double height(const Torus& torus, const Eigen::Vector2d& xy)
{
    const Eigen::Matrix3d axes = frame(torus);
    return torus.point.z() + axes.row(2).dot(offset(torus, axes, xy));
}

Eigen::Vector2d slope(const Torus& torus, const Eigen::Vector2d& xy)
{
    const Eigen::Matrix3d axes = frame(torus);
    const Eigen::Vector3d gradient =
        axes * distance_with_gradients(make_revolution(parameters(torus)), offset(torus, axes, xy)).gradient;
    return -gradient.head<2>() / gradient.z();
}

Eigen::VectorXd height_gradient(const Torus& torus, const Eigen::Vector2d& xy)
{
    const Eigen::Matrix3d axes = frame(torus);
    const RevolutionDistance f = distance_with_gradients(make_revolution(parameters(torus)), offset(torus, axes, xy));
    return -f.parameter_gradient / axes.row(2).dot(f.gradient);
}

double height(const Cone& cone, const Eigen::Vector2d& xy) { return height(torus_of(cone), xy); }
Eigen::Vector2d slope(const Cone& cone, const Eigen::Vector2d& xy) { return slope(torus_of(cone), xy); }
Eigen::VectorXd height_gradient(const Cone& cone, const Eigen::Vector2d& xy)
{
    return height_gradient(torus_of(cone), xy).head(kCurvatureAlong);
}

} // namespace fettle::surface
