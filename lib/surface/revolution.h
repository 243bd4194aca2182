#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle {

/// Parameters of a surface of revolution in the frame (a, b, n) of one of its points: changes of the frame, then its
/// form (Torus, surface.h).
enum RevolutionParameter { kOffset, kTiltAcross, kTiltAlong, kTurn, kAround, kLean, kAlong, kRevolutionParameters };

template <typename T>
using RevolutionParameters = Eigen::Matrix<T, kRevolutionParameters, 1>;

/// Signed orthogonal distance of a point from a surface of revolution with a circular profile: a torus, with `along` =
/// 0 a cone, with `lean` = 0 besides a cylinder, with `lean` = 0 and `along` = `around` a sphere, with neither
/// curvature a plane. By curvatures (Lukács, Martin and Marshall 1998), so that nothing cancels as it becomes flat.
/// With w the axis of revolution and m the direction away from it,
///     w = sin(lean) n + cos(lean) a,   m = cos(lean) n - sin(lean) a,
/// the profile plane has the coordinates w·d and g, the distance from the cylinder about w through the frame's point;
/// the surface is the circle of curvature `along` through the origin there, with the normal (cos lean, sin lean).
/// @param d  the point, in the frame   @param far  what is given where there is no distance: beyond the centre or axis
template <typename T>
T revolution_distance(const Eigen::Matrix<T, 3, 1>& point, const RevolutionParameters<T>& theta, const T& far)
{
    using std::cos;
    using std::sin;
    using std::sqrt;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Vector a = Vector(T(1), theta[kTurn], -theta[kTiltAlong]).normalized();
    const Vector up(T(0), theta[kTiltAcross], T(1));
    const Vector n = (up - up.dot(a) * a).normalized();
    const T c = cos(theta[kLean]), s = sin(theta[kLean]);
    const Vector w = s * n + c * a;
    const Vector d = point - Vector(T(0), T(0), theta[kOffset]);
    const T height = w.dot(d);
    const T away = c * n.dot(d) - s * a.dot(d);
    // Distance from a circle (line) of curvature k: with q = k/2 |x|² + (its normal)·x it is 2q / (1 + √(1 + 2kq)).
    const T q_around = 0.5 * theta[kAround] * (d.squaredNorm() - height * height) + away;
    const T ratio_around = 1.0 + 2.0 * theta[kAround] * q_around;
    if (!(ratio_around > 0.0)) return far;
    const T g = 2.0 * q_around / (1.0 + sqrt(ratio_around));
    const T q = 0.5 * theta[kAlong] * (g * g + height * height) + c * g + s * height;
    const T ratio = 1.0 + 2.0 * theta[kAlong] * q;
    if (!(ratio > 0.0)) return far;
    return 2.0 * q / (1.0 + sqrt(ratio));
}

} // namespace fettle
