#include "robot/workpiece.h"

#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "robot/wide_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// The tree and a first look at triangles are in float; whatever a rounding might have hidden is looked at in double.

namespace fettle {

namespace {

using Eigen::Vector3d;

// Distances are told to this, mm.
constexpr double kDistanceTolerance = 1e-9;
// Depths inside boxes and hulls are told to this, mm, a tenth of what machining asks for: where the way out changes
// sides, every halving costs twice as many pieces.
constexpr double kDepthTolerance = 1e-3;

void take(const PlacedSolid& body, const Vector3d& point, Clearance& best, bool& nearer)
{
    const PointDistance at = body.distance(point);
    if (!(at.value < best.distance)) return;
    best = {at.value, at.gradient, point - at.value * at.gradient, point};
    nearer = true;
}

// No point of the triangle is nearer, by the tangent plane at its middle. The corner that is nearest by it is tried.
double lower_bound(const PlacedSolid& body, const Triangle& t, Clearance& best, bool& nearer)
{
    const Vector3d middle = t.rowwise().mean();
    const PointDistance at = body.distance(middle);
    Eigen::Index corner = 0;
    const double slope = (at.gradient.transpose() * (t.colwise() - middle)).minCoeff(&corner);
    if (at.value + slope < best.distance) take(body, t.col(corner), best, nearer);
    return at.value + slope;
}

// The deepest point of a triangle, by halving its sides where a tangent plane leaves room for a deeper one than is
// known.
void find_deepest(const PlacedSolid& body, const Triangle& whole, Clearance& best, bool& nearer)
{
    std::vector<Triangle> waiting = {whole};
    while (!waiting.empty()) {
        const Triangle t = waiting.back();
        waiting.pop_back();
        if (lower_bound(body, t, best, nearer) >= best.distance - kDepthTolerance) continue;
        const Vector3d a = (t.col(1) + t.col(2)) / 2, b = (t.col(2) + t.col(0)) / 2, c = (t.col(0) + t.col(1)) / 2;
        Triangle part;
        for (const auto& corners :
             {std::array<Vector3d, 3>{t.col(0), c, b}, {c, t.col(1), a}, {b, a, t.col(2)}, {a, b, c}}) {
            part << corners[0], corners[1], corners[2];
            waiting.push_back(part);
        }
    }
}

Triangle triangle_of(const Mesh& mesh, Eigen::Index index)
{
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, index));
    return corners;
}

void offer(const RoundSolid& solid, const PlacedSolid& body, const Triangle& t, Clearance& best, bool& nearer)
{
    if (body.is_sphere()) {
        const Vector3d centre = solid.T.translation();
        const TrianglePoint foot = closest_on_triangle(t, centre);
        const double length = std::sqrt(foot.squared_distance), distance = length - solid.rounding;
        if (distance < best.distance) {
            const Vector3d normal = length > 0 ? Vector3d((foot.point - centre) / length) : Vector3d::UnitZ();
            best = {distance, normal, centre + solid.rounding * normal, foot.point};
            nearer = true;
        }
        if (foot.barycentric.minCoeff() > 0) return; // else it may be one of the two sides of a needle
    }
    if (const auto foot = nearest_of_triangle(solid, t, best.distance)) {
        best = {foot->distance, foot->gradient, foot->point - foot->distance * foot->gradient, foot->point};
        nearer = true;
    }
}

void offer(const BoxSolid&, const PlacedSolid& body, const Triangle& t, Clearance& best, bool& nearer)
{
    if (lower_bound(body, t, best, nearer) >= best.distance - kDistanceTolerance) return;
    const Clearance c = clearance(body, PlacedSolid(t), best.distance);
    if (c.distance <= 0) {
        find_deepest(body, t, best, nearer);
    } else if (c.distance < best.distance) {
        best = c;
        nearer = true;
    }
}

/// A triangle that may be the nearest.
struct Candidate {
    float lower; ///< no point of it is nearer, but for roundings
    std::uint32_t leaf, lane;
};

/// A body on its way through the tree.
template <typename Outline, typename Wide>
struct Search {
    Search(const Outline& of_body, const PlacedSolid& placed, const Mesh& of, const BoxTree& in,
           const std::function<bool(Eigen::Index)>* only, Workpiece::Nearest& found)
        : outline(of_body), body(placed), wide(of_body, in.centre), mesh(of), tree(in), wanted(only), best(found),
          rounding(kRoundings * (in.rounding + kEpsilon * (wide.size + in.box.diagonal().norm())))
    {
        set_bound(best.clearance.distance);
    }

    const Outline& outline;
    const PlacedSolid& body;
    const Wide wide;
    const Mesh& mesh;
    const BoxTree& tree;
    const std::function<bool(Eigen::Index)>* wanted; ///< nullptr: all
    Workpiece::Nearest& best;
    const double rounding;                           ///< of distances in float, mm
    float bound = std::numeric_limits<float>::max(); ///< what is not nearer than this does not matter
    std::array<Candidate, 64> candidates;            ///< hardly ever more than ten wait
    std::size_t waiting = 0;

    /// A point is known to be no farther than this.
    void set_bound(double distance)
    {
        const auto far = static_cast<float>(distance + 2 * rounding);
        if (far < bound) bound = far;
    }

    /// Measures the candidates that still matter, in double: the last ones, the nearest as a rule, first.
    void settle()
    {
        while (waiting > 0) {
            const Candidate& next = candidates[--waiting];
            if (next.lower > bound) continue;
            const Eigen::Index t = tree.triangle(next.leaf, next.lane);
            if (wanted != nullptr && !(*wanted)(t)) continue;
            bool nearer = false;
            offer(outline, body, triangle_of(mesh, t), best.clearance, nearer);
            if (!nearer) continue;
            best.triangle = t;
            best.leaf = next.leaf;
            set_bound(best.clearance.distance);
        }
    }

    FETTLE_INLINE void look_through(std::uint32_t leaf)
    {
        const Least8 least = least_of_triangles(wide, tree.leaves[leaf]);
        if (wide.exact && wanted == nullptr && lanes_of(least.upper < bound) != 0)
            set_bound(static_cast<double>(least_of(least.upper)));
        for (Lanes lanes{lanes_of(least.lower <= bound)}; lanes.any(); lanes.next()) {
            if (waiting == candidates.size()) settle();
            candidates[waiting++] = {least.lower[lanes.first()], leaf, lanes.first()};
        }
    }

    FETTLE_INLINE void go_through(Stack& stack)
    {
        while (stack.any()) {
            const Waiting next = stack.pop();
            if (next.distance > bound) continue;
            if (next.level < 0) {
                look_through(next.index);
                continue;
            }
            const Float8 children = lower_bound(wide, tree.levels[static_cast<std::size_t>(next.level)], next.index);
            stack.push(lanes_of(children <= bound), children, next.level - 1, next.index);
        }
    }

    /// From a leaf that is probably near upwards: of most nodes above it no other child is near enough.
    FETTLE_INLINE void begin_at(std::uint32_t leaf)
    {
        look_through(leaf);
        settle();
        Stack stack;
        std::uint32_t child = leaf;
        for (std::size_t level = 0; level < tree.levels.size(); ++level) {
            const std::uint32_t node = child / 8;
            const Float8 children = lower_bound(wide, tree.levels[level], node);
            const unsigned others = lanes_of(children <= bound) & ~(1u << child % 8);
            stack.push(others, children, static_cast<std::int32_t>(level) - 1, node);
            go_through(stack);
            child = node;
        }
        settle();
    }
};

using SphereSearch = Search<RoundSolid, WideSphere>;
using RoundSearch = Search<RoundSolid, WideRound>;
using BoxSearch = Search<BoxSolid, WideBox>;

FETTLE_CLONES void begin_at(SphereSearch& search, std::uint32_t leaf) { search.begin_at(leaf); }
FETTLE_CLONES void begin_at(RoundSearch& search, std::uint32_t leaf) { search.begin_at(leaf); }
FETTLE_CLONES void begin_at(BoxSearch& search, std::uint32_t leaf) { search.begin_at(leaf); }

} // namespace

bool is_closed(const Mesh& mesh)
{
    std::vector<std::pair<int, int>> sides;
    for (const auto t : mesh.triangles.colwise())
        for (int k = 0; k < 3; ++k) sides.emplace_back(t[k], t[(k + 1) % 3]);
    std::sort(sides.begin(), sides.end());
    if (std::adjacent_find(sides.begin(), sides.end()) != sides.end()) return false;
    return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
        return std::binary_search(sides.begin(), sides.end(), std::pair(side.second, side.first));
    });
}

Workpiece::Workpiece(const Mesh& mesh) : closed_(is_closed(mesh)), index_(mesh) {}

// A ray out of a closed mesh first meets a triangle from behind. One that only grazes it is drawn again.
bool Workpiece::is_inside(const Nearest& nearest, const Vector3d& point) const
{
    if (nearest.triangle >= 0) {
        // Nearest to the inner of a triangle, not to its rim: the side of that triangle tells.
        constexpr double kInner = 1e-3; // barycentric
        const Triangle t = triangle_of(mesh(), nearest.triangle);
        const TrianglePoint foot = closest_on_triangle(t, nearest.clearance.on_b);
        if (foot.barycentric.minCoeff() > kInner)
            return (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)).dot(nearest.clearance.normal) > 0;
    }
    constexpr double kGrazing = 1e-6;
    for (const Vector3d& direction : {Vector3d::UnitZ().eval(), Vector3d(0.8, 0, 0.6), Vector3d(-0.36, 0.48, 0.8)}) {
        const auto hit = index_.cast(point, direction);
        if (!hit) return false;
        const Triangle t = triangle_of(mesh(), hit->triangle);
        const Vector3d normal = (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0));
        const double along = normal.dot(direction);
        if (std::abs(along) > kGrazing * normal.norm()) return along > 0;
    }
    return false;
}

void Workpiece::find(const PlacedSolid& body, const std::function<bool(Eigen::Index)>* wanted, Nearest& best) const
{
    const BoxTree& tree = index_.tree();
    if (tree.leaves.empty()) return;
    best.leaf = std::min<std::uint32_t>(best.leaf, static_cast<std::uint32_t>(tree.leaves.size()) - 1);
    const auto outline = body.outline();
    const auto search = [&](auto&& begun) { begin_at(begun, best.leaf); };
    if (const auto* box = std::get_if<BoxSolid>(&outline))
        search(BoxSearch(*box, body, mesh(), tree, wanted, best));
    else if (body.is_sphere())
        search(SphereSearch(std::get<RoundSolid>(outline), body, mesh(), tree, wanted, best));
    else
        search(RoundSearch(std::get<RoundSolid>(outline), body, mesh(), tree, wanted, best));
}

bool Workpiece::holds(const Vector3d& point) const
{
    return closed_ && index_.tree().box.contains(point) && is_inside({}, point);
}

Workpiece::Nearest Workpiece::nearest_of(const PlacedSolid& body, double beyond,
                                         const std::function<bool(Eigen::Index)>& wanted) const
{
    Nearest best;
    best.clearance.distance = beyond;
    find(body, &wanted, best);
    return best;
}

Workpiece::Nearest Workpiece::nearest(const PlacedSolid& body, double beyond, std::uint32_t leaf) const
{
    Nearest best;
    best.clearance.distance = beyond;
    best.leaf = leaf;
    find(body, nullptr, best);
    // A body that touches the surface is not wholly inside; of a ball its centre tells how deep.
    const bool apart = best.triangle < 0 || best.clearance.distance > 0;
    if (!closed_ || !(apart || body.is_sphere())) return best;
    const Vector3d point = body.farthest(Vector3d::UnitZ());
    if (!index_.tree().box.contains(point) || !is_inside(best, point)) return best;
    if (best.triangle < 0) return nearest(body); // how far out it is must be told
    Clearance& c = best.clearance;
    const double width = (body.farthest(c.normal) - body.farthest(-c.normal)).dot(c.normal) + 2 * body.radius();
    best.inside = true;
    c.distance = -c.distance - width;
    c.normal = -c.normal;
    c.on_a = c.on_b - c.distance * c.normal;
    return best;
}

} // namespace fettle
