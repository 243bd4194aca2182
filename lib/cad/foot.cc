#include "cad/foot.h"

#include "cad/point.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle::cad {
namespace {

constexpr int kMaxSteps = 60;        // Newton takes under ten; from where the distance is not convex, more
constexpr double kStep = 1e-13;      // of the coordinates' size: a step below it changes the last digits
constexpr double kMaxDamping = 1e12; // of the metric: a step then no longer moves the point
constexpr double kMinDamping = 1e-3; // of the metric: less hardly changes a step, so that Newton goes on undamped

/// Range of a parameter; of a periodic one, everything.
struct Limits {
    double min, max;
    double clamp(double x) const { return std::clamp(x, min, max); }
    bool stops(double x, double direction) const { return (x <= min && direction < 0) || (x >= max && direction > 0); }
};

Limits limits(double first, double last, bool is_periodic)
{
    constexpr double kAll = std::numeric_limits<double>::infinity();
    return is_periodic ? Limits{-kAll, kAll} : Limits{first, last};
}

/// Half the squared distance of a point of the surface, its gradient, its Hessian, and the Gauss-Newton part of that.
struct Distance {
    Eigen::Vector3d point;
    double value = 0;
    Eigen::Vector2d gradient;
    Eigen::Matrix2d hessian, metric;
};

Distance distance_at(const Adaptor3d_Surface& surface, const Eigen::Vector2d& uv, const Eigen::Vector3d& to)
{
    gp_Pnt p;
    gp_Vec du, dv, duu, dvv, duv;
    surface.D2(uv.x(), uv.y(), p, du, dv, duu, dvv, duv);
    Distance d;
    d.point = vector_of(p);
    const Eigen::Vector3d r = d.point - to, u = vector_of(du), v = vector_of(dv);
    d.value = r.squaredNorm() / 2;
    d.gradient = {r.dot(u), r.dot(v)};
    d.metric << u.dot(u), u.dot(v), u.dot(v), v.dot(v);
    d.hessian = d.metric;
    d.hessian(0, 0) += r.dot(vector_of(duu));
    d.hessian(1, 1) += r.dot(vector_of(dvv));
    d.hessian(0, 1) += r.dot(vector_of(duv));
    d.hessian(1, 0) = d.hessian(0, 1);
    return d;
}

/// Newton's step where the distance is convex, else one of the damped metric, downhill. Parameters that stand at a
/// limit and would leave it are held.
Eigen::Vector2d step_of(const Distance& d, double damping, const std::array<bool, 2>& is_held)
{
    const double scale = std::max(d.metric.trace(), std::numeric_limits<double>::min());
    const bool is_convex = d.hessian(0, 0) > 0 && d.hessian(1, 1) > 0 && d.hessian.determinant() > 0;
    Eigen::Matrix2d matrix = is_convex ? d.hessian : d.metric;
    matrix.diagonal() += (damping + (is_convex ? 0 : 1e-12)) * (d.metric.diagonal().array() + 1e-15 * scale).matrix();
    Eigen::Vector2d gradient = d.gradient;
    for (int k = 0; k < 2; ++k)
        if (is_held[static_cast<std::size_t>(k)]) {
            matrix(0, 1) = matrix(1, 0) = 0;
            matrix(k, k) = 1;
            gradient[k] = 0;
        }
    const double det = matrix.determinant();
    if (!(det > 0)) return -gradient / scale;
    return -Eigen::Vector2d(matrix(1, 1) * gradient[0] - matrix(0, 1) * gradient[1],
                            matrix(0, 0) * gradient[1] - matrix(1, 0) * gradient[0]) /
           det;
}

} // namespace

SurfaceFoot foot_on_surface(const Adaptor3d_Surface& surface, const Eigen::Vector2d& start,
                            const Eigen::Vector3d& point)
{
    const std::array<Limits, 2> range = {
        limits(surface.FirstUParameter(), surface.LastUParameter(), surface.IsUPeriodic()),
        limits(surface.FirstVParameter(), surface.LastVParameter(), surface.IsVPeriodic())};
    Eigen::Vector2d uv(range[0].clamp(start[0]), range[1].clamp(start[1]));
    Distance d = distance_at(surface, uv, point);
    std::array<bool, 2> is_held{};
    double damping = 0;
    for (int step = 0; step < kMaxSteps && damping < kMaxDamping; ++step) {
        for (std::size_t k = 0; k < 2; ++k)
            is_held[k] = range[k].stops(uv[Eigen::Index(k)], -d.gradient[Eigen::Index(k)]);
        const Eigen::Vector2d by = step_of(d, damping, is_held);
        const Eigen::Vector2d next(range[0].clamp(uv[0] + by[0]), range[1].clamp(uv[1] + by[1]));
        const double moved = std::sqrt(std::max(0.0, (next - uv).dot(d.metric * (next - uv))));
        const double smallest = kStep * (1 + point.cwiseAbs().maxCoeff());
        const Distance there = distance_at(surface, next, point);
        if (there.value <= d.value) {
            uv = next;
            d = there;
            damping = damping > kMinDamping ? damping / 10 : 0;
            if (moved <= smallest) break;
        } else {
            if (moved <= smallest) break; // rounding alone
            damping = std::max(kMinDamping, 10 * damping);
        }
    }
    for (std::size_t k = 0; k < 2; ++k) is_held[k] = range[k].stops(uv[Eigen::Index(k)], -d.gradient[Eigen::Index(k)]);
    return {uv, d.point, is_held[0] || is_held[1]};
}

CurveFoot foot_on_curve(const Adaptor3d_Curve& curve, double start, const Eigen::Vector3d& point)
{
    const double first = curve.FirstParameter(), last = curve.LastParameter();
    const double smallest = kStep * (1 + point.cwiseAbs().maxCoeff());
    gp_Pnt p;
    gp_Vec d1, d2;
    double t = std::clamp(start, first, last), damping = 0;
    curve.D2(t, p, d1, d2);
    Eigen::Vector3d at = vector_of(p), tangent = vector_of(d1), second = vector_of(d2);
    for (int step = 0; step < kMaxSteps && damping < kMaxDamping; ++step) {
        const Eigen::Vector3d r = at - point;
        const double gradient = r.dot(tangent), metric = tangent.squaredNorm();
        const double hessian = metric + r.dot(second);
        if (!(metric > 0)) break;
        const double by = -gradient / ((hessian > 0 ? hessian : metric) + damping * metric);
        const double next = std::clamp(t + by, first, last);
        const double moved = std::abs(next - t) * std::sqrt(metric);
        curve.D2(next, p, d1, d2);
        if ((vector_of(p) - point).squaredNorm() <= r.squaredNorm()) {
            t = next;
            at = vector_of(p);
            tangent = vector_of(d1);
            second = vector_of(d2);
            damping = damping > kMinDamping ? damping / 10 : 0;
            if (moved <= smallest) break;
        } else {
            if (moved <= smallest) break; // rounding alone
            damping = std::max(kMinDamping, 10 * damping);
        }
    }
    const double length = tangent.norm();
    constexpr double kEnd = 1e-7; // mm: OpenCASCADE's own tolerance of points
    return {t, at, (t - first) * length <= kEnd || (last - t) * length <= kEnd};
}

} // namespace fettle::cad
