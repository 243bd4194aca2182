#include "machining/drop_cutter.h"

#include "machining/cutter_side.h"
#include "mesh/facet_from_above.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fettle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNothing = -std::numeric_limits<double>::infinity();

template <typename Side>
double rise_at(const Side& side, double square)
{
    return side.rise(Double4{} + square)[0];
}

/// z of the tip that rests on a point; NaN or −∞ beyond the cutter.
template <typename Side>
double on_vertex(const Side& side, const Vector3d& vertex, const Vector2d& xy)
{
    return vertex.z() - rise_at(side, (xy - vertex.head<2>()).squaredNorm());
}

/// z of the tip that rests between the ends of an edge. Over the edge's line the contact is where z − rise is greatest:
/// the least of −z + rise, the height of a sweep whose slope is the edge's, turned.
template <typename Side>
double on_edge(const Cutter& cutter, const Vector3d& a, const Vector3d& b, const Vector2d& xy)
{
    const double length = (b - a).head<2>().norm();
    if (length == 0) return kNothing; // upright: its upper end counts
    const Vector2d way = (b - a).head<2>() / length, q = xy - a.head<2>();
    const double along = q.dot(way), across = way.x() * q.y() - way.y() * q.x(), slope = (b.z() - a.z()) / length;
    if (std::abs(across) > cutter.radius || along < -cutter.radius || along > length + cutter.radius) return kNothing;
    const Side side(cutter, -slope);
    const double beside = slope == 0 ? 0 : side.lead(Double4{} + across)[0];
    const double at = along + beside;
    if (!(at >= 0 && at <= length)) return kNothing;
    // the rim of a lead that ends there is within the cutter, but for rounding
    const double square = std::min(beside * beside + across * across, cutter.radius * cutter.radius);
    return a.z() + slope * at - rise_at(side, square);
}

/// z of the tip that rests on the inside of a facet, where the lower side has its slope; on a steeper one the rim.
double on_facet(const Mesh& mesh, const Cutter& cutter, Eigen::Index triangle, const Vector2d& xy)
{
    const Eigen::Vector3i t = mesh.triangles.col(triangle);
    const Vector3d a = mesh.vertices.col(t[0]);
    Vector3d normal = (mesh.vertices.col(t[1]) - a).cross(mesh.vertices.col(t[2]) - a);
    const double area = normal.norm();
    if (normal.z() == 0 || area == 0) return kNothing;
    normal *= (normal.z() > 0 ? 1 : -1) / area;
    const double level = normal.head<2>().norm();
    const bool has_cone = cutter.cone_from < cutter.radius;
    const bool steep = has_cone && level > cutter.cone_slope * normal.z();
    const double offset = steep ? cutter.radius : cutter.flat + cutter.corner * level;
    const Vector2d outwards = level > 0 ? Vector2d(normal.head<2>() / level) : Vector2d(0, 0);
    const auto z = FacetFromAbove(mesh, triangle).height(xy - offset * outwards);
    if (!z) return kNothing;
    return steep ? *z - rise(cutter, cutter.radius) : *z - cutter.corner * (1 - normal.z());
}

std::vector<std::uint8_t> ownership(const Mesh& mesh)
{
    std::vector<std::uint8_t> own(static_cast<std::size_t>(mesh.triangles.cols()), 0);
    std::vector<bool> seen(static_cast<std::size_t>(mesh.vertices.cols()), false);
    std::vector<std::tuple<int, int, std::size_t, int>> edges;
    for (std::size_t t = 0; t < own.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles(k, static_cast<Eigen::Index>(t));
            const int b = mesh.triangles((k + 1) % 3, static_cast<Eigen::Index>(t));
            if (!seen[static_cast<std::size_t>(a)]) own[t] |= static_cast<std::uint8_t>(1 << k);
            seen[static_cast<std::size_t>(a)] = true;
            edges.emplace_back(std::min(a, b), std::max(a, b), t, k);
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& [a, b, t, k] = edges[i];
        if (i > 0 && std::get<0>(edges[i - 1]) == a && std::get<1>(edges[i - 1]) == b) continue;
        own[t] |= static_cast<std::uint8_t>(8 << k);
    }
    return own;
}

} // namespace

DropCutter::DropCutter(const Mesh& mesh, const Cutter& cutter)
    : mesh_(mesh), cutter_(cutter), grid_(mesh), own_(ownership(mesh))
{
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, t));
        boxes_.push_back({corners.topRows<2>().rowwise().minCoeff(), corners.topRows<2>().rowwise().maxCoeff(),
                          corners.row(2).maxCoeff()});
    }
}

template <typename Side>
double DropCutter::drop(const Vector2d& xy) const
{
    double highest = kNothing;
    const auto offer = [&highest](double z) { highest = z > highest ? z : highest; }; // never NaN
    const Side level(cutter_, 0);
    const Vector2d reach = Vector2d::Constant(cutter_.radius);
    const auto look = [&](Eigen::Index t) {
        const auto n = static_cast<std::size_t>(t);
        // No point of it is higher than its top, nor nearer than its box.
        const Box& box = boxes_[n];
        if (box.top <= highest) return;
        const double near = (box.low - xy.array()).max(xy.array() - box.high).max(0).matrix().squaredNorm();
        if (near > cutter_.radius * cutter_.radius || box.top - rise_at(level, near) <= highest) return;
        offer(on_facet(mesh_, cutter_, t, xy));
        for (int k = 0; k < 3; ++k) {
            const Vector3d a = mesh_.vertices.col(mesh_.triangles(k, t));
            if ((own_[n] & (1 << k)) != 0) offer(on_vertex(level, a, xy));
            if ((own_[n] & (8 << k)) != 0)
                offer(on_edge<Side>(cutter_, a, mesh_.vertices.col(mesh_.triangles((k + 1) % 3, t)), xy));
        }
    };
    grid_.visit(xy, xy, look); // what is high enough to rule out most of the rest is likely here
    grid_.visit(xy - reach, xy + reach, look);
    return highest;
}

std::optional<double> DropCutter::operator()(const Vector2d& xy) const
{
    const double z = with_side(cutter_, [&]<typename Side>() { return drop<Side>(xy); });
    if (z == kNothing) return std::nullopt;
    return z;
}

} // namespace fettle
