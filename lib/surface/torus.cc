#include "core/constants.h"
#include "surface/quadratic.h"
#include "surface/revolution.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <cmath>

namespace fettle {

namespace {

Torus torus_of(const Cone& cone) { return {cone.point, cone.normal, cone.axis, cone.around, cone.lean, 0}; }

/// Columns a, b, n.
Eigen::Matrix3d frame(const Torus& torus)
{
    Eigen::Matrix3d axes;
    axes << torus.axis, torus.normal.cross(torus.axis), torus.normal;
    return axes;
}

RevolutionParameters parameters(const Torus& torus)
{
    RevolutionParameters theta = RevolutionParameters::Zero();
    theta[kAround] = torus.around;
    theta[kLean] = torus.lean;
    theta[kAlong] = torus.along;
    return theta;
}

/// From the point to the surface over xy, in the frame; by Newton's method along the vertical from the osculating
/// paraboloid. NaN where the surface does not rise from the metal there.
Eigen::Vector3d offset(const Torus& torus, const Eigen::Matrix3d& axes, const Eigen::Vector2d& xy)
{
    constexpr int kIterations = 50;    // twice as many as a start on the far flank needs
    constexpr double kSettled = 1e-13; // of the distance from the point: rounding
    const Eigen::Vector3d vertical = axes.row(2);
    const Eigen::Vector3d level =
        axes.transpose() * Eigen::Vector3d(xy.x() - torus.point.x(), xy.y() - torus.point.y(), 0);
    const double across = torus.around * std::cos(torus.lean);
    const auto half = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
        return (torus.along * p[0] * q[0] + across * p[1] * q[1]) / 2;
    };
    double z =
        rising_root(half(vertical, vertical), vertical[2] + 2 * half(level, vertical), half(level, level) + level[2]);
    if (std::isnan(z)) z = -level[2] / vertical[2];
    const Revolution surface = revolution(parameters(torus));
    for (int i = 0; i < kIterations; ++i) {
        const Eigen::Vector3d d = level + z * vertical;
        const RevolutionDistance f = distance_and_slopes(surface, d);
        const double rise = f.by_point.dot(vertical);
        if (!(rise > 0)) return Eigen::Vector3d::Constant(kNaN);
        const double step = f.value / rise;
        z -= step;
        if (std::abs(step) <= kSettled * d.norm()) return level + z * vertical;
    }
    return Eigen::Vector3d::Constant(kNaN);
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
        axes * distance_and_slopes(revolution(parameters(torus)), offset(torus, axes, xy)).by_point;
    return -gradient.head<2>() / gradient.z();
}

Eigen::VectorXd height_gradient(const Torus& torus, const Eigen::Vector2d& xy)
{
    const Eigen::Matrix3d axes = frame(torus);
    const RevolutionDistance f = distance_and_slopes(revolution(parameters(torus)), offset(torus, axes, xy));
    return -f.by_theta / axes.row(2).dot(f.by_point);
}

Eigen::VectorXi parameter_powers(const Torus&) { return (Eigen::VectorXi(7) << 1, 0, 0, 0, -1, 0, -1).finished(); }

double height(const Cone& cone, const Eigen::Vector2d& xy) { return height(torus_of(cone), xy); }
Eigen::Vector2d slope(const Cone& cone, const Eigen::Vector2d& xy) { return slope(torus_of(cone), xy); }
Eigen::VectorXd height_gradient(const Cone& cone, const Eigen::Vector2d& xy)
{
    return height_gradient(torus_of(cone), xy).head(kAlong);
}
Eigen::VectorXi parameter_powers(const Cone&) { return (Eigen::VectorXi(6) << 1, 0, 0, 0, -1, 0).finished(); }

} // namespace fettle
