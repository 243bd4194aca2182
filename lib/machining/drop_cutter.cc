#include "machining/drop_cutter.h"

#include "core/simd.h"
#include "machining/cutter_side.h"
#include "mesh/box_search.h"
#include "mesh/facet_from_above.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fettle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Touch = DropCutter::Touch;
using Own = std::vector<std::uint8_t>; ///< of each triangle (DropCutter)

constexpr double kNothing = -std::numeric_limits<double>::infinity();

/// The highest touch so far, of a cutter over xy.
template <typename Side>
struct Drop {
    Drop(const Cutter& c, const Vector2d& place) : cutter(c), level(c, 0), xy(place) {}

    void offer(double z, const Vector3d& contact)
    {
        if (z > highest.z) highest = {z, contact}; // never NaN
    }

    /// The cutter rests on a point; NaN or −∞ beyond the cutter.
    void on_vertex(const Vector3d& vertex)
    {
        offer(vertex.z() - rise_at(level, (xy - vertex.head<2>()).squaredNorm()), vertex);
    }

    /// It rests between the ends of an edge. Over the edge's line the contact is where z − rise is greatest: the least
    /// of −z + rise, the height of a sweep whose slope is the edge's, turned.
    void on_edge(const Vector3d& a, const Vector3d& b)
    {
        const double length = (b - a).head<2>().norm();
        if (length == 0) return; // upright: its upper end counts
        const Vector2d way = (b - a).head<2>() / length, q = xy - a.head<2>();
        const double along = q.dot(way), across = way.x() * q.y() - way.y() * q.x(), slope = (b.z() - a.z()) / length;
        if (std::abs(across) > cutter.radius) return;
        // no higher than its higher end at its nearest place
        const double near = along - std::clamp(along, 0.0, length);
        if (!(std::max(a.z(), b.z()) - rise_at(level, near * near + across * across) > highest.z)) return;
        const Side side(cutter, -slope);
        const double beside = slope == 0 ? 0 : side.lead(Double4{} + across)[0];
        const double at = along + beside;
        if (!(at >= 0 && at <= length)) return;
        // the rim of a lead that ends there is within the cutter, but for rounding
        const double square = std::min(beside * beside + across * across, cutter.radius * cutter.radius);
        offer(a.z() + slope * at - rise_at(side, square), a + at / length * (b - a));
    }

    /// It rests on the inside of a facet, where the lower side has its slope; on a steeper one the rim.
    /// @return  may it rest higher on a corner or side of it, which lie in its plane?
    bool on_facet(const Mesh& mesh, Eigen::Index triangle)
    {
        const Eigen::Vector3i t = mesh.triangles.col(triangle);
        const Vector3d a = mesh.vertices.col(t[0]), ab = mesh.vertices.col(t[1]) - a, ac = mesh.vertices.col(t[2]) - a;
        Vector3d normal = ab.cross(ac);
        const double area = normal.norm();
        if (normal.z() == 0 || area == 0) return true;
        normal *= (normal.z() > 0 ? 1 : -1) / area;
        const double out = normal.head<2>().norm();
        const bool has_cone = cutter.cone_from < cutter.radius;
        const bool steep = has_cone && out > cutter.cone_slope * normal.z();
        const double offset = steep ? cutter.radius : cutter.flat + cutter.corner * out;
        const Vector2d outwards = out > 0 ? Vector2d(normal.head<2>() / out) : Vector2d(0, 0);
        const Vector2d foot = xy - offset * outwards, from = foot - a.head<2>();
        const double over_contact = steep ? rise(cutter, cutter.radius) : cutter.corner * (1 - normal.z());
        // On the whole plane, and how far roundings of the normal may turn it, more the narrower the facet.
        const double whole = a.z() - normal.head<2>().dot(from) / normal.z() - over_contact;
        constexpr double kRoundings = 8 * std::numeric_limits<double>::epsilon();
        const double turned = kRoundings * std::sqrt(ab.squaredNorm() * ac.squaredNorm()) / area;
        if (!(whole + turned * (from.norm() + cutter.radius) / normal.z() > highest.z)) return false;
        const auto z = FacetFromAbove(mesh, triangle).height(foot);
        if (z) offer(*z - over_contact, {foot.x(), foot.y(), *z});
        return !z;
    }

    static double rise_at(const Side& side, double square) { return side.rise(Double4{} + square)[0]; }

    const Cutter& cutter;
    const Side level;
    const Vector2d xy;
    Touch highest{kNothing, Vector3d::Zero()};
};

/// A cutter over a place among the boxes of a tree, in its coordinates.
struct Over {
    float x, y;
    float rounding; ///< of a coordinate, of the place, and of a height
    float radius, flat, corner, cone_from, cone_slope;
};

Over over(const Cutter& c, const Vector2d& xy, const BoxTree& tree)
{
    const Vector2d place = xy - tree.centre.head<2>();
    const double reach = std::max(place.cwiseAbs().maxCoeff(), tree.box.sizes().maxCoeff()) + rise(c, c.radius);
    const auto narrow = [](double value) { return static_cast<float>(value); };
    return {narrow(place.x()),   narrow(place.y()),   narrow(8 * (tree.rounding + kEpsilon * reach)),
            narrow(c.radius),    narrow(c.flat),      narrow(c.corner),
            narrow(c.cone_from), narrow(c.cone_slope)};
}

/// No tip that rests on what is in one of eight boxes is higher than its top less the rise at its nearest place. All
/// roundings are to the safe side; −∞ for boxes beyond the cutter.
FETTLE_INLINE Float8 highest_tips(const Float8 (&least)[3], const Float8 (&most)[3], const Over& over)
{
    constexpr auto kLess = static_cast<float>(1 - 16 * kEpsilon), kMore = static_cast<float>(16 * kEpsilon);
    const Float8 x = larger(larger(least[0] - over.x, over.x - most[0]) - over.rounding, Float8{});
    const Float8 y = larger(larger(least[1] - over.y, over.y - most[1]) - over.rounding, Float8{});
    const Float8 distance = kLess * root(x * x + y * y);
    const Float8 on_torus =
        smaller(larger(distance - over.flat, Float8{}), all(over.cone_from - over.flat)); // from the disc
    const float r2 = over.corner * over.corner;
    const Float8 height = over.corner + root(larger(r2 - on_torus * on_torus, Float8{}) + kMore * r2);
    const Float8 torus = kLess * on_torus * on_torus / (height + std::numeric_limits<float>::min());
    const Float8 cone = kLess * over.cone_slope * larger(distance - over.cone_from, Float8{});
    const Float8 tips = most[2] - torus - cone + over.rounding;
    return distance <= over.radius ? tips : all(-std::numeric_limits<float>::infinity());
}

/// @return  the lanes in which tips may be higher than what is found
FETTLE_CLONES unsigned promising(const Boxes8& boxes, const Over& over, float found, Float8& tips)
{
    tips = highest_tips(boxes.least, boxes.most, over);
    return lanes_of(tips > found);
}
FETTLE_CLONES unsigned promising(const Triangles8& triangles, const Over& over, float found, Float8& tips)
{
    const auto& [a, b, c] = triangles.corner;
    Float8 least[3], most[3];
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
        least[axis] = smaller(a[axis], smaller(b[axis], c[axis]));
        most[axis] = larger(a[axis], larger(b[axis], c[axis]));
    }
    tips = highest_tips(least, most, over);
    return lanes_of(tips > found);
}

template <typename Side>
void look_at(Drop<Side>& drop, const Mesh& mesh, Eigen::Index t, std::uint8_t own)
{
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    const auto z = [&](int k) { return mesh.vertices(2, corners[k]); };
    if (!(std::max({z(0), z(1), z(2)}) > drop.highest.z)) return;
    if (!drop.on_facet(mesh, t)) return;
    for (int k = 0; k < 3; ++k) {
        const Vector3d a = mesh.vertices.col(corners[k]);
        if ((own & (1 << k)) != 0) drop.on_vertex(a);
        if ((own & (8 << k)) != 0) drop.on_edge(a, mesh.vertices.col(corners[(k + 1) % 3]));
    }
}

/// The most promising part of the mesh first; what cannot be higher than what is found is left out.
template <typename Side>
Touch highest_touch(const BoxTree& tree, const Mesh& mesh, const Own& own, const Cutter& cutter, const Vector2d& xy)
{
    Drop<Side> drop(cutter, xy);
    const Over at = over(cutter, xy, tree);
    const auto found = [&] { return static_cast<float>(drop.highest.z - tree.centre.z()) - at.rounding; };
    Stack stack;
    stack.push({-std::numeric_limits<float>::infinity(), static_cast<std::int32_t>(tree.levels.size()) - 1, 0});
    while (stack.any()) {
        const Waiting next = stack.pop();
        if (!(-next.distance > found())) continue;
        Float8 tips;
        if (next.level >= 0) {
            const Boxes8& boxes = tree.levels[static_cast<std::size_t>(next.level)].boxes[next.index];
            const unsigned lanes = promising(boxes, at, found(), tips);
            stack.push(lanes, -tips, next.level - 1, next.index);
            continue;
        }
        for (Lanes left{promising(tree.leaves[next.index], at, found(), tips)}; left.any(); left.next()) {
            const Eigen::Index t = tree.triangle(next.index, left.first());
            if (tips[left.first()] > found()) look_at(drop, mesh, t, own[static_cast<std::size_t>(t)]);
        }
    }
    return drop.highest;
}

Own ownership(const Mesh& mesh)
{
    Own own(static_cast<std::size_t>(mesh.triangles.cols()), 0);
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
    : mesh_(mesh), cutter_(cutter), tree_(mesh), own_(ownership(mesh))
{
}

std::optional<Touch> DropCutter::operator()(const Vector2d& xy) const
{
    if (tree_.levels.empty() || !xy.allFinite()) return std::nullopt;
    const Touch touch =
        with_side(cutter_, [&]<typename Side>() { return highest_touch<Side>(tree_, mesh_, own_, cutter_, xy); });
    if (touch.z == kNothing) return std::nullopt;
    return touch;
}

} // namespace fettle
