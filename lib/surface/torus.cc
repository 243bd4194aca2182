#include "surface/quadratic.h"
#include "surface/revolution.h"
#include "surface/shapes.h"

#include <ceres/jet.h>

#include <cmath>
#include <limits>

namespace fettle {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Torus torus_of(const Cone& cone) { return {cone.point, cone.normal, cone.axis, cone.around, cone.lean, 0}; }

/// Columns a, b, n.
Eigen::Matrix3d frame(const Torus& torus)
{
    Eigen::Matrix3d axes;
    axes << torus.axis, torus.normal.cross(torus.axis), torus.normal;
    return axes;
}

RevolutionParameters<double> parameters(const Torus& torus)
{
    RevolutionParameters<double> theta = RevolutionParameters<double>::Zero();
    theta[kAround] = torus.around;
    theta[kLean] = torus.lean;
    theta[kAlong] = torus.along;
    return theta;
}

/// The distance and its derivatives by `N` parameters that `vary` along.
template <int N>
ceres::Jet<double, N> distance(const Torus& torus, const Eigen::Vector3d& d, const Eigen::Matrix<double, 3, N>& d_vary,
                               const Eigen::Matrix<double, kRevolutionParameters, N>& theta_vary)
{
    using T = ceres::Jet<double, N>;
    Eigen::Matrix<T, 3, 1> point;
    for (int i = 0; i < 3; ++i) {
        point[i].a = d[i];
        point[i].v = d_vary.row(i);
    }
    const RevolutionParameters<double> values = parameters(torus);
    RevolutionParameters<T> theta;
    for (int i = 0; i < kRevolutionParameters; ++i) {
        theta[i].a = values[i];
        theta[i].v = theta_vary.row(i);
    }
    return revolution_distance<T>(point, theta, T(kNan));
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
    const Eigen::Matrix<double, kRevolutionParameters, 1> fixed =
        Eigen::Matrix<double, kRevolutionParameters, 1>::Zero();
    for (int i = 0; i < kIterations; ++i) {
        const Eigen::Vector3d d = level + z * vertical;
        const ceres::Jet<double, 1> f = distance<1>(torus, d, vertical, fixed);
        if (!(f.v[0] > 0)) return Eigen::Vector3d::Constant(kNan);
        const double step = f.a / f.v[0];
        z -= step;
        if (std::abs(step) <= kSettled * d.norm()) return level + z * vertical;
    }
    return Eigen::Vector3d::Constant(kNan);
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
    const Eigen::Matrix<double, kRevolutionParameters, 3> fixed =
        Eigen::Matrix<double, kRevolutionParameters, 3>::Zero();
    const ceres::Jet<double, 3> f = distance<3>(torus, offset(torus, axes, xy), axes.transpose(), fixed);
    return -f.v.head<2>() / f.v[2];
}

Eigen::VectorXd height_gradient(const Torus& torus, const Eigen::Vector2d& xy)
{
    constexpr int N = kRevolutionParameters + 1; // the last: along the vertical
    const Eigen::Matrix3d axes = frame(torus);
    Eigen::Matrix<double, 3, N> d_vary = Eigen::Matrix<double, 3, N>::Zero();
    d_vary.col(N - 1) = axes.row(2);
    Eigen::Matrix<double, kRevolutionParameters, N> theta_vary;
    theta_vary.setIdentity();
    const ceres::Jet<double, N> f = distance<N>(torus, offset(torus, axes, xy), d_vary, theta_vary);
    return -f.v.head<N - 1>() / f.v[N - 1];
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
