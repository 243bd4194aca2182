#include "surface/revolution.h"

#include "core/constants.h"

#include <cmath>

namespace fettle::surface {

namespace {

using Eigen::Vector3d;

/// Derivative of v/|v| for the derivative `change` of v.
Vector3d derivative_of_unit(const Vector3d& unit, double norm, const Vector3d& change)
{
    return (change - unit.dot(change) * unit) / norm;
}

/// Signed distance f of a point x from the circle (or line) of curvature k through the origin with unit normal n: with
/// q = k/2 |x|² + n·x it is f = 2q / (1 + r), r = √(1 + 2kq), so that ∂f/∂q = 1/r and ∂f/∂k = -f²/2r.
struct CircleDistance {
    double f, r;
};
CircleDistance circle_distance(double k, double q)
{
    const double ratio = 1 + 2 * k * q;
    if (!(ratio > 0)) return {core::kNaN, core::kNaN};
    const double r = std::sqrt(ratio);
    return {2 * q / (1 + r), r};
}

/// A point relative to the axis of revolution and the profile.
struct Profile {
    Vector3d d;
    double height, radial, across2; ///< w·d, m·d, |d|² - (w·d)²
    CircleDistance around, along;
};

Profile profile(const Revolution& surface, const Vector3d& point)
{
    Profile p;
    p.d = Vector3d(point.x(), point.y(), point.z() - surface.offset);
    p.height = surface.w.dot(p.d);
    p.radial = surface.m.dot(p.d);
    p.across2 = p.d.squaredNorm() - p.height * p.height;
    p.around = circle_distance(surface.curvature_around, surface.curvature_around * p.across2 / 2 + p.radial);
    const double g = p.around.f;
    p.along = circle_distance(surface.curvature_along, surface.curvature_along * (g * g + p.height * p.height) / 2 +
                                                           surface.c * g + surface.s * p.height);
    return p;
}

} // namespace

Revolution make_revolution(const RevolutionParameters& theta)
{
    const Vector3d to(1, theta[kTurn], -theta[kTiltAlong]);
    const double to_norm = to.norm();
    const Vector3d a = to / to_norm;
    const Vector3d up(0, theta[kTiltAcross], 1);
    const double up_a = up.dot(a);
    const Vector3d across = up - up_a * a;
    const double across_norm = across.norm();
    const Vector3d n = across / across_norm;
    const double c = std::cos(theta[kLean]), s = std::sin(theta[kLean]);
    Revolution surface;
    surface.w = s * n + c * a;
    surface.m = c * n - s * a;
    surface.c = c;
    surface.s = s;
    surface.offset = theta[kOffset];
    surface.curvature_around = theta[kCurvatureAround];
    surface.curvature_along = theta[kCurvatureAlong];
    surface.w_theta.setZero();
    surface.m_theta.setZero();
    const auto set = [&](RevolutionParameter k, const Vector3d& to_change, const Vector3d& up_change) {
        const Vector3d da = derivative_of_unit(a, to_norm, to_change);
        const Vector3d dn =
            derivative_of_unit(n, across_norm, up_change - (up_change.dot(a) + up.dot(da)) * a - up_a * da);
        surface.w_theta.col(k) = s * dn + c * da;
        surface.m_theta.col(k) = c * dn - s * da;
    };
    set(kTiltAcross, Vector3d::Zero(), Vector3d::UnitY());
    set(kTiltAlong, -Vector3d::UnitZ(), Vector3d::Zero());
    set(kTurn, Vector3d::UnitY(), Vector3d::Zero());
    surface.w_theta.col(kLean) = surface.m;
    surface.m_theta.col(kLean) = -surface.w;
    return surface;
}

double distance(const Revolution& surface, const Vector3d& point) { return profile(surface, point).along.f; }

RevolutionDistance distance_with_gradients(const Revolution& surface, const Vector3d& point)
{
    const Profile p = profile(surface, point);
    const double g = p.around.f, f = p.along.f;
    const double by_g = (surface.curvature_along * g + surface.c) / p.along.r;
    const double by_q = by_g / p.around.r; // derivative by q of the circle around the axis
    const double by_height =
        (surface.curvature_along * p.height + surface.s) / p.along.r - by_q * surface.curvature_around * p.height;
    RevolutionDistance result;
    result.value = f;
    result.gradient = by_height * surface.w + by_q * surface.m + by_q * surface.curvature_around * p.d;
    for (const RevolutionParameter k : {kTiltAcross, kTiltAlong, kTurn})
        result.parameter_gradient[k] =
            by_height * surface.w_theta.col(k).dot(p.d) + by_q * surface.m_theta.col(k).dot(p.d);
    result.parameter_gradient[kOffset] = -result.gradient.z();
    result.parameter_gradient[kCurvatureAround] = by_q * p.across2 / 2 - by_g * g * g / (2 * p.around.r);
    // ∂w/∂lean = m and ∂m/∂lean = -w
    result.parameter_gradient[kLean] =
        by_height * p.radial - by_q * p.height + (surface.c * p.height - surface.s * g) / p.along.r;
    result.parameter_gradient[kCurvatureAlong] = (g * g + p.height * p.height - f * f) / (2 * p.along.r);
    return result;
}

} // namespace fettle::surface
