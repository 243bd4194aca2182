#include "mesh/triangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace fettle::mesh {

namespace {

// Squared ratio of height to length below which a triangle is treated as its three edges. In such a needle rounding
// (1e-16 over this ratio) could move the foot of the perpendicular by more than the needle's width.
constexpr double kMinSquaredAspect = 1e-10;

TrianglePoint closest_on_edge(const Triangle& triangle, int from, int to, const Eigen::Vector3d& point)
{
    const Eigen::Vector3d a = triangle.col(from);
    const Eigen::Vector3d edge = triangle.col(to) - a;
    const double squared_length = edge.squaredNorm();
    const double t = squared_length > 0 ? std::clamp((point - a).dot(edge) / squared_length, 0.0, 1.0) : 0.0;
    TrianglePoint closest;
    closest.barycentric[from] = 1 - t;
    closest.barycentric[to] = t;
    closest.point = t == 1 ? Eigen::Vector3d(triangle.col(to)) : Eigen::Vector3d(a + t * edge);
    closest.squared_distance = (point - closest.point).squaredNorm();
    return closest;
}

} // namespace

TrianglePoint closest_on_triangle(const Triangle& triangle, const Eigen::Vector3d& point)
{
    const Eigen::Vector3d a = triangle.col(0);
    const Eigen::Vector3d ab = triangle.col(1) - a;
    const Eigen::Vector3d ac = triangle.col(2) - a;
    const Eigen::Vector3d normal = ab.cross(ac);
    const double squared_area = normal.squaredNorm(); // of the parallelogram
    const double squared_length = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (squared_area > kMinSquaredAspect * squared_length * squared_length) {
        const Eigen::Vector3d ap = point - a;
        const double v = ap.cross(ac).dot(normal) / squared_area;
        const double w = ab.cross(ap).dot(normal) / squared_area;
        if (v > 0 && w > 0 && 1 - v - w > 0) {
            TrianglePoint inside;
            inside.barycentric << 1 - v - w, v, w;
            inside.point = a + v * ab + w * ac;
            inside.squared_distance = (point - inside.point).squaredNorm();
            return inside;
        }
    }
    TrianglePoint nearest = closest_on_edge(triangle, 0, 1, point);
    for (const auto& [from, to] : {std::pair(1, 2), std::pair(2, 0)})
        if (const TrianglePoint other = closest_on_edge(triangle, from, to, point);
            other.squared_distance < nearest.squared_distance)
            nearest = other;
    return nearest;
}

WatertightRay::WatertightRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) : origin_(origin)
{
    direction.cwiseAbs().maxCoeff(&kz_);
    kx_ = (kz_ + 1) % 3;
    ky_ = (kz_ + 2) % 3;
    sx_ = direction[kx_] / direction[kz_];
    sy_ = direction[ky_] / direction[kz_];
    sz_ = 1 / direction[kz_];
}

std::optional<double> WatertightRay::hit(const Triangle& triangle) const
{
    const Eigen::Matrix3d corners = triangle.colwise() - origin_;
    const Eigen::RowVector3d x = corners.row(kx_) - sx_ * corners.row(kz_);
    const Eigen::RowVector3d y = corners.row(ky_) - sy_ * corners.row(kz_);
    // Scaled barycentric coordinates: twice the signed areas of the ray with the edges opposite to the corners.
    const double u = x[2] * y[1] - y[2] * x[1];
    const double v = x[0] * y[2] - y[0] * x[2];
    const double w = x[1] * y[0] - y[1] * x[0];
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    const double sum = u + v + w;
    if (sum == 0) return std::nullopt;
    const double distance = sz_ * (u * corners(kz_, 0) + v * corners(kz_, 1) + w * corners(kz_, 2)) / sum;
    if (!(distance >= 0)) return std::nullopt;
    return distance;
}

} // namespace fettle::mesh
