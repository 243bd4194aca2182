#include "surface/revolution.h"

#include "core/constants.h"
#include "core/simd.h"

#include <cmath>
#include <cstring>

namespace fettle::surface {

namespace {

using Eigen::Vector3d;

/// Derivative of v/|v| for the derivative `change` of v.
Vector3d derivative_of_unit(const Vector3d& unit, double norm, const Vector3d& change)
{
    return (change - unit.dot(change) * unit) / norm;
}

using core::cwise_sqrt;
using core::Double4;

FETTLE_INLINE double cwise_sqrt(double a) { return std::sqrt(a); }

/// Signed distance f of a point x from the circle (or line) of curvature k through the origin with unit normal n: with
/// q = k/2 |x|² + n·x it is f = 2q / (1 + r), r = √(1 + 2kq), so that ∂f/∂q = 1/r and ∂f/∂k = -f²/2r.
/// @tparam Number  double, or Double4 for four points
template <typename Number>
struct CircleDistance {
    Number f, r;
};
template <typename Number>
FETTLE_INLINE CircleDistance<Number> circle_distance(double k, const Number& q)
{
    const Number nan = Number{} + core::kNaN, ratio = 1 + 2 * k * q, r = cwise_sqrt(ratio > 0 ? ratio : nan);
    return {2 * q / (1 + r), r};
}

template <typename Number>
struct Place {
    Number x, y, z;
};

/// In the order in which Eigen adds.
template <typename Number>
FETTLE_INLINE Number dot(const Vector3d& a, const Place<Number>& d)
{
    return a.x() * d.x + (a.y() * d.y + a.z() * d.z);
}

/// A point relative to the axis of revolution and the profile.
template <typename Number>
struct Profile {
    Place<Number> d;
    Number height, radial, across2; ///< w·d, m·d, |d|² - (w·d)²
    CircleDistance<Number> around, along;
};

template <typename Number>
FETTLE_INLINE Profile<Number> profile(const Revolution& surface, const Place<Number>& point)
{
    Profile<Number> p;
    p.d = {point.x, point.y, point.z - surface.offset};
    p.height = dot(surface.w, p.d);
    p.radial = dot(surface.m, p.d);
    p.across2 = p.d.x * p.d.x + (p.d.y * p.d.y + p.d.z * p.d.z) - p.height * p.height;
    p.around = circle_distance<Number>(surface.curvature_around, surface.curvature_around * p.across2 / 2 + p.radial);
    const Number g = p.around.f;
    p.along =
        circle_distance<Number>(surface.curvature_along, surface.curvature_along * (g * g + p.height * p.height) / 2 +
                                                             surface.c * g + surface.s * p.height);
    return p;
}

template <typename Number>
struct Derivatives {
    Place<Number> by_point;
    Number by_parameter[kRevolutionParameterCount];
};

template <typename Number>
FETTLE_INLINE Derivatives<Number> derivatives(const Revolution& surface, const Profile<Number>& p)
{
    const Number g = p.around.f, f = p.along.f;
    const Number by_g = (surface.curvature_along * g + surface.c) / p.along.r;
    const Number by_q = by_g / p.around.r; // derivative by q of the circle around the axis
    const Number by_height =
        (surface.curvature_along * p.height + surface.s) / p.along.r - by_q * surface.curvature_around * p.height;
    const auto by_coordinate = [&](Eigen::Index k, const Number& d) {
        return by_height * surface.w[k] + by_q * surface.m[k] + by_q * surface.curvature_around * d;
    };
    Derivatives<Number> result;
    result.by_point = {by_coordinate(0, p.d.x), by_coordinate(1, p.d.y), by_coordinate(2, p.d.z)};
    Number* const by = result.by_parameter;
    for (const RevolutionParameter k : {kTiltAcross, kTiltAlong, kTurn})
        by[k] = by_height * dot<Number>(surface.w_theta.col(k), p.d) + by_q * dot<Number>(surface.m_theta.col(k), p.d);
    by[kOffset] = -result.by_point.z;
    by[kCurvatureAround] = by_q * p.across2 / 2 - by_g * g * g / (2 * p.around.r);
    // ∂w/∂lean = m and ∂m/∂lean = -w
    by[kLean] = by_height * p.radial - by_q * p.height + (surface.c * p.height - surface.s * g) / p.along.r;
    by[kCurvatureAlong] = (g * g + p.height * p.height - f * f) / (2 * p.along.r);
    return result;
}

template <typename Number>
FETTLE_INLINE Number load(const double* from)
{
    Number result;
    std::memcpy(&result, from, sizeof result);
    return result;
}

template <typename Number>
FETTLE_INLINE void store(const Number& number, double* to)
{
    std::memcpy(to, &number, sizeof number);
}

/// As many points as a Number holds, from row i.
template <typename Number>
FETTLE_INLINE void distances_at(const Revolution& surface, const Eigen::MatrixX3d& points, Eigen::Index i,
                                double* values, RevolutionJacobian* by_parameters)
{
    const double *const x = points.data() + i, *const y = x + points.rows(), *const z = y + points.rows();
    const Profile<Number> p = profile<Number>(surface, {load<Number>(x), load<Number>(y), load<Number>(z)});
    store(p.along.f, values + i);
    if (by_parameters == nullptr) return;
    const Derivatives<Number> all = derivatives(surface, p);
    for (int k = 0; k < kRevolutionParameterCount; ++k) store(all.by_parameter[k], &(*by_parameters)(i, k));
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

RevolutionDistance distance_with_gradients(const Revolution& surface, const Vector3d& point)
{
    const Profile<double> p = profile<double>(surface, {point.x(), point.y(), point.z()});
    const Derivatives<double> all = derivatives(surface, p);
    return {p.along.f,
            {all.by_point.x, all.by_point.y, all.by_point.z},
            Eigen::Map<const RevolutionParameters>(all.by_parameter)};
}

FETTLE_CLONES void distances(const Revolution& surface, const Eigen::MatrixX3d& points, double* values,
                             RevolutionJacobian* by_parameters)
{
    constexpr Eigen::Index kLanes = 4;
    Eigen::Index i = 0;
    for (; i + kLanes <= points.rows(); i += kLanes) distances_at<Double4>(surface, points, i, values, by_parameters);
    for (; i < points.rows(); ++i) distances_at<double>(surface, points, i, values, by_parameters);
}

} // namespace fettle::surface
