#include "machining/drop_cutter.h"

#include "core/simd.h"
#include "machining/cutter_side.h"
#include "mesh/box_search.h"
#include "mesh/facet_from_above.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fettle::machining {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Touch = DropCutter::Touch;

/// The highest touch found so far of a cutter whose axis is at xy.
template <typename Side>
struct HighestTouch {
    HighestTouch(const Cutter& c, const Vector2d& axis) : cutter(c), level(c, 0), xy(axis) {}

    void update(double z, const Vector3d& contact)
    {
        if (z > highest.z) highest = {z, contact}; // false for NaN
    }

    /// Touch of a vertex; the height is NaN or −∞ outside the cutter.
    void test_vertex(const Vector3d& vertex)
    {
        update(vertex.z() - rise_at(level, (xy - vertex.head<2>()).squaredNorm()), vertex);
    }

    /// Touch between the ends of an edge. The contact maximises z − rise along the edge: it minimises −z + rise, the
    /// height of a sweep with the negative slope of the edge.
    void test_edge(const Vector3d& a, const Vector3d& b)
    {
        const double length = (b - a).head<2>().norm();
        if (length == 0) return; // a vertical edge touches with its upper vertex
        const Vector2d u = (b - a).head<2>() / length, q = xy - a.head<2>();
        const double along = q.dot(u), across = u.x() * q.y() - u.y() * q.x(), slope = (b.z() - a.z()) / length;
        if (std::abs(across) > cutter.radius) return;
        // Upper bound: the higher end, placed at the nearest point of the edge.
        const double near = along - std::clamp(along, 0.0, length);
        if (!(std::max(a.z(), b.z()) - rise_at(level, near * near + across * across) > highest.z)) return;
        const Side side(cutter, -slope);
        const double lead = slope == 0 ? 0 : side.lead(broadcast(across))[0];
        const double at = along + lead;
        if (!(at >= 0 && at <= length)) return;
        // Rounding must not move a contact on the rim outside the cutter.
        const double square = std::min(lead * lead + across * across, cutter.radius * cutter.radius);
        update(a.z() + slope * at - rise_at(side, square), a + at / length * (b - a));
    }

    /// Touch of the inside of a facet: at the point of the lower side with the facet's slope; a facet steeper than the
    /// cone touches the rim.
    /// @return  whether a corner or an edge of the facet may touch higher
    bool test_facet(const mesh::Mesh& mesh, Eigen::Index triangle)
    {
        const Eigen::Vector3i t = mesh.triangles.col(triangle);
        const Vector3d a = mesh.vertices.col(t[0]), ab = mesh.vertices.col(t[1]) - a, ac = mesh.vertices.col(t[2]) - a;
        Vector3d normal = ab.cross(ac);
        const double area = normal.norm();
        if (normal.z() == 0 || area == 0) return true;
        normal *= (normal.z() > 0 ? 1 : -1) / area;
        const double horizontal = normal.head<2>().norm();
        const bool has_cone = cutter.cone_from < cutter.radius;
        const bool steep = has_cone && horizontal > cutter.cone_slope * normal.z();
        const double offset = steep ? cutter.radius : cutter.flat + cutter.corner * horizontal;
        const Vector2d outwards = horizontal > 0 ? Vector2d(normal.head<2>() / horizontal) : Vector2d(0, 0);
        const Vector2d foot = xy - offset * outwards, from = foot - a.head<2>();
        const double contact_rise = steep ? rise(cutter, cutter.radius) : cutter.corner * (1 - normal.z());
        // Tip height on the facet's plane, and a bound of the angle by which rounding turns the normal of a sliver.
        const double on_plane = a.z() - normal.head<2>().dot(from) / normal.z() - contact_rise;
        constexpr double kAngleRounding = 8 * std::numeric_limits<double>::epsilon();
        const double turned = kAngleRounding * std::sqrt(ab.squaredNorm() * ac.squaredNorm()) / area;
        if (!(on_plane + turned * (from.norm() + cutter.radius) / normal.z() > highest.z)) return false;
        const auto z = mesh::FacetFromAbove(mesh, triangle).height(foot);
        if (z) update(*z - contact_rise, {foot.x(), foot.y(), *z});
        return !z;
    }

    static double rise_at(const Side& side, double square) { return side.rise(broadcast(square))[0]; }

    const Cutter& cutter;
    const Side level; ///< the lower side at slope 0
    const Vector2d xy;
    Touch highest{-core::kInfinity, Vector3d::Zero()};
};

/// A cutter in the coordinates of a box tree.
struct CutterQuery {
    float x, y;     ///< of the axis
    float rounding; ///< bound of the rounding of the axis and of a rise
    float radius, flat, corner, cone_from, cone_slope;
};

// Bound on the number of float operations that the tip's height on a box takes.
constexpr double kMaxHeightRoundings = 16;

CutterQuery make_query(const Cutter& c, const Vector2d& xy, const mesh::BoxTree& tree)
{
    const Vector2d axis = xy - tree.centre.head<2>();
    const double size = axis.cwiseAbs().maxCoeff() + rise(c, c.radius);
    const auto narrow = [](double value) { return static_cast<float>(value); };
    return {narrow(axis.x()),    narrow(axis.y()),    narrow(kMaxHeightRoundings * mesh::kFloatRoundoff * size),
            narrow(c.radius),    narrow(c.flat),      narrow(c.corner),
            narrow(c.cone_from), narrow(c.cone_slope)};
}

/// Upper bounds of the tip's height on the contents of eight boxes: the top of each box less the rise at its nearest
/// point. All roundings are upwards; −∞ for boxes outside the cutter.
FETTLE_INLINE mesh::Float8 tip_upper_bounds(const mesh::Float8 (&min)[3], const mesh::Float8 (&max)[3],
                                            const CutterQuery& query)
{
    constexpr auto kRoundDownFactor = static_cast<float>(1 - 16 * mesh::kFloatRoundoff),
                   kRelativeRounding = static_cast<float>(16 * mesh::kFloatRoundoff);
    const mesh::Float8 x =
        mesh::cwise_max(mesh::cwise_max(min[0] - query.x, query.x - max[0]) - query.rounding, mesh::Float8{});
    const mesh::Float8 y =
        mesh::cwise_max(mesh::cwise_max(min[1] - query.y, query.y - max[1]) - query.rounding, mesh::Float8{});
    const mesh::Float8 distance = kRoundDownFactor * mesh::cwise_sqrt(x * x + y * y);
    const mesh::Float8 from_disc = mesh::cwise_min(mesh::cwise_max(distance - query.flat, mesh::Float8{}),
                                                   mesh::broadcast(query.cone_from - query.flat));
    const float r2 = query.corner * query.corner;
    const mesh::Float8 height =
        query.corner +
        mesh::cwise_sqrt(mesh::cwise_max(r2 - from_disc * from_disc, mesh::Float8{}) + kRelativeRounding * r2);
    const mesh::Float8 torus = kRoundDownFactor * from_disc * from_disc / (height + std::numeric_limits<float>::min());
    const mesh::Float8 cone =
        kRoundDownFactor * query.cone_slope * mesh::cwise_max(distance - query.cone_from, mesh::Float8{});
    const mesh::Float8 tips = max[2] - torus - cone + query.rounding;
    return distance <= query.radius ? tips : mesh::broadcast(-std::numeric_limits<float>::infinity());
}

/// Computes upper bounds of the tip's height. @return  the lanes in which they exceed the height found so far
FETTLE_CLONES unsigned candidates(const mesh::Boxes8& boxes, const CutterQuery& query, float found, mesh::Float8& tips)
{
    tips = tip_upper_bounds(boxes.min, boxes.max, query);
    return mesh::lane_bits(tips > found);
}
FETTLE_CLONES unsigned candidates(const mesh::PackedTriangles8& leaf, const CutterQuery& query, float found,
                                  mesh::Float8& tips)
{
    const mesh::Boxes8 boxes = mesh::enlarged(mesh::boxes_of(unpack(leaf)), mesh::margin(leaf));
    tips = tip_upper_bounds(boxes.min, boxes.max, query);
    return mesh::lane_bits(tips > found);
}

template <typename Side>
void test_triangle(HighestTouch<Side>& touch, const mesh::Mesh& mesh, Eigen::Index t, std::uint8_t owned)
{
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    const auto z = [&](int k) { return mesh.vertices(2, corners[k]); };
    if (!(std::max({z(0), z(1), z(2)}) > touch.highest.z)) return;
    if (!touch.test_facet(mesh, t)) return;
    for (int k = 0; k < 3; ++k) {
        const Vector3d a = mesh.vertices.col(corners[k]);
        if ((owned & (1 << k)) != 0) touch.test_vertex(a);
        if ((owned & (8 << k)) != 0) touch.test_edge(a, mesh.vertices.col(corners[(k + 1) % 3]));
    }
}

/// Branch and bound: the boxes with the highest upper bounds first.
template <typename Side>
Touch highest_touch(const mesh::BoxTree& tree, const mesh::Mesh& mesh, const std::vector<std::uint8_t>& owned,
                    const Cutter& cutter, const Vector2d& xy)
{
    HighestTouch<Side> touch(cutter, xy);
    const CutterQuery query = make_query(cutter, xy, tree);
    const auto found = [&] {
        const auto z = static_cast<float>(touch.highest.z - tree.centre.z());
        return z - std::abs(z) * mesh::kBoundRoundingError - query.rounding;
    };
    mesh::NodeStack stack;
    stack.push({-std::numeric_limits<float>::infinity(), static_cast<std::int32_t>(tree.levels.size()) - 1, 0});
    while (stack.any()) {
        const mesh::StackEntry next = stack.pop();
        if (!(-next.distance > found())) continue;
        mesh::Float8 tips;
        if (next.level >= 0) {
            const mesh::Boxes8& boxes = tree.levels[next.level].boxes[next.index];
            const unsigned lanes = candidates(boxes, query, found(), tips);
            stack.push(lanes, -tips, next.level - 1, next.index);
            continue;
        }
        const unsigned lanes = candidates(tree.leaves[next.index], query, found(), tips);
        for (mesh::LaneIterator left{lanes}; left.any(); left.next()) {
            const Eigen::Index t = tree.triangle(next.index, left.first());
            if (tips[left.first()] > found()) test_triangle(touch, mesh, t, owned[t]);
        }
    }
    return touch.highest;
}

/// DropCutter::owned_ of a mesh.
std::vector<std::uint8_t> assign_owners(const mesh::Mesh& mesh)
{
    std::vector<std::uint8_t> owned(mesh.triangles.cols(), 0);
    std::vector<bool> has_owner(mesh.vertices.cols(), false);
    std::vector<std::tuple<int, int, std::size_t, int>> edges;
    for (std::size_t t = 0; t < owned.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles(k, t), b = mesh.triangles((k + 1) % 3, t);
            if (!has_owner[a]) owned[t] |= 1 << k;
            has_owner[a] = true;
            edges.emplace_back(std::min(a, b), std::max(a, b), t, k);
        }
    std::ranges::sort(edges);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& [a, b, t, k] = edges[i];
        if (i > 0 && std::get<0>(edges[i - 1]) == a && std::get<1>(edges[i - 1]) == b) continue;
        owned[t] |= 8 << k;
    }
    return owned;
}

} // namespace

DropCutter::DropCutter(const mesh::Mesh& mesh, const Cutter& cutter)
    : mesh_(mesh), cutter_(cutter), tree_(mesh), owned_(assign_owners(mesh))
{
}

std::optional<Touch> DropCutter::operator()(const Vector2d& xy) const
{
    if (tree_.levels.empty() || !xy.allFinite()) return std::nullopt;
    const Touch touch =
        with_side(cutter_, [&]<typename Side>() { return highest_touch<Side>(tree_, mesh_, owned_, cutter_, xy); });
    if (touch.z == -core::kInfinity) return std::nullopt;
    return touch;
}

} // namespace fettle::machining
