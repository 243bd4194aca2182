#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "robot/deepest_point.h"
#include "robot/wide_solid.h"
#include "robot/workpiece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// The tree and the first bounds of triangles are in float. What remains possible within rounding is measured in double.

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// Accuracy of distances, mm.
constexpr double kDistanceTolerance = 1e-9;

// Lower bound of the distance of a triangle's points, from the tangent plane of the distance at its centroid. The
// corner where that plane is lowest becomes `best` if it is nearer.
double lower_bound(const PlacedSolid& body, const mesh::Triangle& t, Clearance& best, bool& improved)
{
    const Vector3d centroid = t.rowwise().mean();
    const PointDistance at = body.signed_distance(centroid);
    Eigen::Index k = 0;
    const double slope = (at.gradient.transpose() * (t.colwise() - centroid)).minCoeff(&k);
    if (at.value + slope < best.distance) {
        const Vector3d corner = t.col(k);
        const PointDistance d = body.signed_distance(corner);
        if (d.value < best.distance) {
            best = {d.value, d.gradient, corner - d.value * d.gradient, corner};
            improved = true;
        }
    }
    return at.value + slope;
}

// The triangle's nearest point to a round solid becomes `best` if it is nearer.
void measure(const RoundSolid& solid, const PlacedSolid& body, const mesh::Triangle& t, Clearance& best, bool& improved)
{
    if (body.is_sphere()) {
        const Vector3d centre = solid.T.translation();
        const mesh::TrianglePoint foot = mesh::closest_on_triangle(t, centre);
        const double length = std::sqrt(foot.squared_distance), distance = length - solid.rounding;
        if (distance < best.distance) {
            const Vector3d normal = length > 0 ? Vector3d((foot.point - centre) / length) : Vector3d::UnitZ();
            best = {distance, normal, centre + solid.rounding * normal, foot.point};
            improved = true;
        }
        if (foot.barycentric.minCoeff() > 0) return; // on an edge of a needle the other edge may be nearer
    }
    if (const auto foot = nearest_point_of_triangle(solid, t, best.distance)) {
        best = {foot->distance, foot->gradient, foot->point - foot->distance * foot->gradient, foot->point};
        improved = true;
    }
}

// The triangle's nearest point to a box, hull or triangle becomes `best` if it is nearer.
void measure(const BoxSolid&, const PlacedSolid& body, const mesh::Triangle& t, Clearance& best, bool& improved)
{
    if (lower_bound(body, t, best, improved) >= best.distance - kDistanceTolerance) return;
    const Clearance c = clearance(body, PlacedSolid(t), best.distance);
    if (c.distance <= 0) {
        improved = find_deepest(body, t, best) || improved;
    } else if (c.distance < best.distance) {
        best = c;
        improved = true;
    }
}

/// A triangle that may be the nearest.
struct Candidate {
    float lower_bound; ///< of its distance, within rounding
    std::uint32_t leaf, lane;
};

/// The search for the triangle nearest to a body. Outline is the body's shape in double, Wide the same in float.
template <typename Outline, typename Wide>
struct TreeSearch {
    TreeSearch(const Outline& shape, const PlacedSolid& placed, const mesh::Mesh& of, const mesh::BoxTree& in,
               const std::function<bool(Eigen::Index)>* selection, Workpiece::Nearest& found, bool only_bounds)
        : outline(shape), body(placed), mesh(of), tree(in), is_selected(selection), bounds_only(only_bounds),
          best(found)
    {
    }

    const Outline& outline;
    const PlacedSolid& body;
    const mesh::Mesh& mesh;
    const mesh::BoxTree& tree;
    const std::function<bool(Eigen::Index)>* is_selected; ///< nullptr: all triangles count
    const bool bounds_only; ///< the result is the smallest lower bound, no triangle is measured
    Workpiece::Nearest& best;
    const Wide wide = Wide(outline, tree.centre);
    /// Error bound of distances in float, mm, but for the margins of boxes and leaves.
    const double rounding = 2 * mesh::kMaxRoundings * mesh::kFloatRoundoff * wide.size;
    /// Upper bound of the minimum distance in float, mm: triangles above it are not nearest in double either.
    float upper_bound = std::min(std::numeric_limits<float>::max(), float(best.clearance.distance + 2 * rounding));
    std::array<Candidate, 64> candidates; ///< rarely more than ten at a time
    std::size_t candidate_count = 0;

    void set_upper_bound(double distance) { upper_bound = std::min(upper_bound, float(distance + 2 * rounding)); }

    /// Measures the candidates that are still possible in double. The last one, usually the nearest, comes first.
    void refine_candidates()
    {
        while (candidate_count > 0) {
            const Candidate& next = candidates[--candidate_count];
            if (next.lower_bound > upper_bound) continue;
            const Eigen::Index t = tree.triangle(next.leaf, next.lane);
            if (is_selected != nullptr && !(*is_selected)(t)) continue;
            bool improved = false;
            measure(outline, body, mesh::triangle_of(mesh, t), best.clearance, improved);
            if (!improved) continue;
            best.triangle = t;
            best.leaf = next.leaf;
            set_upper_bound(best.clearance.distance);
        }
    }

    FETTLE_INLINE void scan_leaf(std::uint32_t leaf)
    {
        const float margin = mesh::margin(tree.leaves[leaf]);
        MinDistance8 distances = min_distances(wide, unpack(tree.leaves[leaf]));
        distances.lower -= margin;
        distances.upper += margin;
        if (bounds_only) {
            for (mesh::LaneIterator lanes{mesh::lane_bits(distances.lower < upper_bound)}; lanes.any(); lanes.next()) {
                const float lower = distances.lower[lanes.first()];
                if (!(lower < upper_bound)) continue;
                upper_bound = lower;
                best.leaf = leaf;
            }
            return;
        }
        if (wide.exact && is_selected == nullptr && mesh::lane_bits(distances.upper < upper_bound) != 0)
            set_upper_bound(mesh::min_lane(distances.upper));
        for (mesh::LaneIterator lanes{mesh::lane_bits(distances.lower <= upper_bound)}; lanes.any(); lanes.next()) {
            if (candidate_count == candidates.size()) refine_candidates();
            candidates[candidate_count++] = {distances.lower[lanes.first()], leaf, lanes.first()};
        }
    }

    FETTLE_INLINE void traverse(mesh::NodeStack& stack)
    {
        while (stack.any()) {
            const mesh::StackEntry next = stack.pop();
            if (next.distance > upper_bound) continue;
            if (next.level < 0) {
                scan_leaf(next.index);
                continue;
            }
            const mesh::Float8 children = lower_bound(wide, tree.levels[next.level], next.index);
            stack.push(mesh::lane_bits(children <= upper_bound), children, next.level - 1, next.index);
        }
    }

    /// Searches upwards from a leaf that is probably near: most nodes above it have no other child that is near enough.
    FETTLE_INLINE void run_from(std::uint32_t leaf)
    {
        scan_leaf(leaf);
        refine_candidates();
        mesh::NodeStack stack;
        std::uint32_t child = leaf;
        for (std::size_t level = 0; level < tree.levels.size(); ++level) {
            const std::uint32_t node = child / 8;
            const mesh::Float8 children = lower_bound(wide, tree.levels[level], node);
            const unsigned siblings = mesh::lane_bits(children <= upper_bound) & ~(1u << child % 8);
            stack.push(siblings, children, static_cast<std::int32_t>(level) - 1, node);
            traverse(stack);
            child = node;
        }
        refine_candidates();
    }
};

using SphereSearch = TreeSearch<RoundSolid, WideSphere>;
using CapsuleSearch = TreeSearch<RoundSolid, WideCapsule>;
using RoundSearch = TreeSearch<RoundSolid, WideRound>;
using BoxSearch = TreeSearch<BoxSolid, WideBox>;

// Functions with clones for several processors cannot be templates.
FETTLE_CLONES void run_from(SphereSearch& search, std::uint32_t leaf) { search.run_from(leaf); }
FETTLE_CLONES void run_from(CapsuleSearch& search, std::uint32_t leaf) { search.run_from(leaf); }
FETTLE_CLONES void run_from(RoundSearch& search, std::uint32_t leaf) { search.run_from(leaf); }
FETTLE_CLONES void run_from(BoxSearch& search, std::uint32_t leaf) { search.run_from(leaf); }

} // namespace

void Workpiece::search(const PlacedSolid& body, const std::function<bool(Eigen::Index)>* is_selected, Nearest& best,
                       bool bounds_only) const
{
    const mesh::BoxTree& tree = index_.tree();
    if (tree.leaves.empty()) return;
    best.leaf = std::min<std::uint32_t>(best.leaf, static_cast<std::uint32_t>(tree.leaves.size()) - 1);
    const auto outline = body.primitive_shape();
    const auto run = [&](auto&& search) {
        run_from(search, best.leaf);
        if (bounds_only)
            best.clearance.distance = std::min(best.clearance.distance, search.upper_bound - search.rounding);
    };
    if (const auto* box = std::get_if<BoxSolid>(&outline)) {
        run(BoxSearch(*box, body, mesh(), tree, is_selected, best, bounds_only));
        return;
    }
    const auto& round = std::get<RoundSolid>(outline);
    if (body.is_sphere())
        run(SphereSearch(round, body, mesh(), tree, is_selected, best, bounds_only));
    else if (round.radius_from == 0 && round.radius_to == 0)
        run(CapsuleSearch(round, body, mesh(), tree, is_selected, best, bounds_only));
    else
        run(RoundSearch(round, body, mesh(), tree, is_selected, best, bounds_only));
}

} // namespace fettle::robot
