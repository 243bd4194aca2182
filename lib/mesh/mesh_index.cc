#include "mesh/mesh_index.h"

#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "mesh/ray_search.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// Branch and bound. Boxes and triangles are first measured in float, eight at a time, with bounds that allow for the
// rounding errors; only the triangles that these bounds cannot exclude are measured in double.

namespace fettle::mesh {

namespace {

// Unit roundoff of double.
constexpr double kDoubleRoundoff = std::numeric_limits<double>::epsilon() / 2;

/// A triangle that may be the closest.
struct Candidate {
    float squared_lower_bound; ///< of its distance, mm²
    std::uint32_t leaf, lane;
};

/// A closest point query: the point, the closest triangle so far, and the candidates not yet measured in double.
struct ClosestQuery {
    /// @param centred_point  the query point relative to the tree's centre
    /// @param radius  triangles farther away are not searched for, mm
    /// @param float_error  bound on the error that rounding to float causes in a distance to the point, mm
    ClosestQuery(const Eigen::Vector3d& query_point, const Eigen::Vector3d& centred_point, double radius,
                 double float_error)
        : point(query_point), distance_error(float_error)
    {
        Eigen::Vector3f::Map(centred) = centred_point.cast<float>();
        closest.squared_distance = radius * radius;
        tighten_bound(radius);
    }

    const Eigen::Vector3d& point;
    float centred[3];
    double distance_error;
    TrianglePoint closest;
    Eigen::Index triangle = kNoTriangle;
    std::uint32_t leaf = 0;
    float squared_bound = std::numeric_limits<float>::max(); ///< finite, so that it excludes empty boxes
    std::array<Candidate, 64> candidates;                    ///< the first `pending`, rarely more than six
    std::size_t pending = 0;

    /// Lowers the bound beyond which boxes and triangles are excluded to `distance`, mm, plus rounding errors.
    void tighten_bound(double distance)
    {
        const double bound = (distance + distance_error) * (1 + kMaxRoundings * kFloatRoundoff);
        if (bound * bound < squared_bound) squared_bound = static_cast<float>(bound * bound);
    }

    /// Measures a triangle in double and keeps it if it is closer, or equally close with a lower index.
    void update(const Triangle& corners, Eigen::Index index, std::uint32_t in_leaf)
    {
        const TrianglePoint other = closest_on_triangle(corners, point);
        if (other.squared_distance > closest.squared_distance) return;
        if (other.squared_distance == closest.squared_distance && index >= triangle) return;
        closest = other;
        triangle = index;
        leaf = in_leaf;
        tighten_bound(std::sqrt(closest.squared_distance));
    }
};

/// Measures all pending candidates in double, the last one first because it is usually the closest. Candidates that the
/// bound has excluded in the meantime are skipped.
void refine_candidates(ClosestQuery& query, const BoxTree& tree, const Mesh& mesh)
{
    while (query.pending > 0) {
        const Candidate& candidate = query.candidates[--query.pending];
        if (candidate.squared_lower_bound > query.squared_bound) continue;
        const Eigen::Index t = tree.triangle(candidate.leaf, candidate.lane);
        query.update(triangle_of(mesh, t), t, candidate.leaf);
    }
}

/// Measures the eight triangles of a leaf in float and adds those within the bound to the candidates.
FETTLE_INLINE void scan_leaf(std::uint32_t leaf, ClosestQuery& query, const BoxTree& tree, const Mesh& mesh)
{
    const Bounds8 squared = squared_distances(tree.leaves[leaf], query.centred);
    if (lane_bits(squared.upper < query.squared_bound) != 0)
        query.tighten_bound(std::sqrt(static_cast<double>(min_lane(squared.upper))) + query.distance_error);
    for (LaneIterator lanes{lane_bits(squared.lower <= query.squared_bound)}; lanes.any(); lanes.next()) {
        if (query.pending == query.candidates.size()) refine_candidates(query, tree, mesh);
        query.candidates[query.pending++] = {squared.lower[lanes.first()], leaf, lanes.first()};
    }
}

/// Visits the nodes on the stack and their descendants, depth first, except those that the bound excludes.
FETTLE_INLINE void traverse(NodeStack& stack, ClosestQuery& query, const BoxTree& tree, const Mesh& mesh)
{
    while (stack.any()) {
        const StackEntry node = stack.pop();
        if (node.distance > query.squared_bound) continue;
        if (node.level < 0) {
            scan_leaf(node.index, query, tree, mesh);
            continue;
        }
        const Float8 squared = squared_distance(tree.levels[node.level], node.index, query.centred);
        stack.push(lane_bits(squared <= query.squared_bound), squared, node.level - 1, node.index);
    }
}

/// Searches the whole tree, from a leaf that is probably near upwards: its triangles give a bound that excludes most
/// siblings of the nodes above it.
FETTLE_CLONES void find_closest(ClosestQuery& query, std::uint32_t leaf, const BoxTree& tree, const Mesh& mesh)
{
    scan_leaf(leaf, query, tree, mesh);
    NodeStack stack;
    std::uint32_t child = leaf;
    for (std::size_t level = 0; level < tree.levels.size(); ++level) {
        const std::uint32_t parent = child / 8;
        const Float8 squared = squared_distance(tree.levels[level], parent, query.centred);
        const unsigned siblings = lane_bits(squared <= query.squared_bound) & ~(1u << child % 8);
        stack.push(siblings, squared, static_cast<std::int32_t>(level) - 1, parent);
        traverse(stack, query, tree, mesh);
        child = parent;
    }
    refine_candidates(query, tree, mesh);
}

/// Adds the triangles whose boxes come within a distance of a point. @param point  relative to the tree's centre
FETTLE_CLONES void find_nearby(const float (&point)[3], float squared_bound, const BoxTree& tree,
                               std::vector<std::uint32_t>& found)
{
    NodeStack stack;
    stack.push({0, static_cast<std::int32_t>(tree.levels.size()) - 1, 0});
    while (stack.any()) {
        const StackEntry node = stack.pop();
        if (node.level >= 0) {
            const Float8 squared = squared_distance(tree.levels[node.level], node.index, point);
            stack.push(lane_bits(squared <= squared_bound), squared, node.level - 1, node.index);
            continue;
        }
        const PackedTriangles8& leaf = tree.leaves[node.index];
        const Boxes8 boxes = enlarged(boxes_of(unpack(leaf)), margin(leaf));
        for (LaneIterator lanes{lane_bits(squared_distance(boxes, point) <= squared_bound)}; lanes.any(); lanes.next())
            if (std::size_t{8} * node.index + lanes.first() < tree.triangle_order.size())
                found.push_back(static_cast<std::uint32_t>(tree.triangle(node.index, lanes.first())));
    }
}

/// Bound on the error that the rounding to float causes in the distances to a point. Besides its coordinates a
/// triangle's are rounded: by no more than the point's are, and by a share of their difference that the relative errors
/// of all distances cover. @param centred_point  relative to the tree's centre
double float_error(const Eigen::Vector3d& centred_point)
{
    constexpr double kMaxNormPerComponent = 2; // > √3, the norm of a vector over its largest component
    return 2 * kMaxNormPerComponent * kFloatRoundoff * centred_point.cwiseAbs().maxCoeff();
}

} // namespace

struct MeshIndex::State {
    explicit State(const Mesh& indexed) : mesh(indexed), tree(indexed) {}

    const Mesh& mesh;
    BoxTree tree;
};

MeshIndex::MeshIndex(const Mesh& mesh) : state_(std::make_unique<State>(mesh)) {}
MeshIndex::MeshIndex(MeshIndex&&) noexcept = default;
MeshIndex::~MeshIndex() = default;

const Mesh& MeshIndex::mesh() const { return state_->mesh; }
const BoxTree& MeshIndex::tree() const { return state_->tree; }

std::optional<MeshIndex::Hit> MeshIndex::cast(const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& unit_direction) const
{
    return first_hit(state_->tree, state_->mesh, origin, unit_direction);
}

std::optional<MeshIndex::Hit> MeshIndex::highest(double x, double y) const
{
    if (state_->tree.levels.empty()) return std::nullopt;
    return cast({x, y, state_->tree.box.max().z()}, -Eigen::Vector3d::UnitZ());
}

std::optional<MeshIndex::Closest> MeshIndex::closest(const Eigen::Vector3d& point, double radius,
                                                     std::uint32_t leaf) const
{
    const BoxTree& tree = state_->tree;
    if (tree.levels.empty() || !point.allFinite() || !(radius >= 0)) return std::nullopt;
    const Eigen::Vector3d centred = point - tree.centre;
    ClosestQuery query(point, centred, radius, float_error(centred));
    const auto last_leaf = static_cast<std::uint32_t>(tree.leaves.size()) - 1;
    find_closest(query, std::min(leaf, last_leaf), tree, state_->mesh);
    if (query.triangle == kNoTriangle) return std::nullopt;
    return Closest{query.closest.point, query.triangle, query.closest.barycentric, query.leaf};
}

std::vector<std::uint32_t> MeshIndex::nearby(const Eigen::Vector3d& point, double distance) const
{
    std::vector<std::uint32_t> found;
    const BoxTree& tree = state_->tree;
    if (tree.levels.empty() || !point.allFinite() || !(distance >= 0)) return found;
    const Eigen::Vector3d centred = point - tree.centre;
    float rounded[3];
    Eigen::Vector3f::Map(rounded) = centred.cast<float>();
    const double bound = (distance + float_error(centred)) * (1 + kMaxRoundings * kFloatRoundoff);
    // Rounded upwards, and finite, so that it excludes empty boxes.
    const double squared =
        std::min(bound * bound * (1 + 2 * kFloatRoundoff), double{std::numeric_limits<float>::max()});
    find_nearby(rounded, static_cast<float>(squared), tree, found);
    std::erase_if(found, [&](std::uint32_t t) { // which only the tree's rounding let in
        const Triangle corners = triangle_of(state_->mesh, t);
        const Eigen::AlignedBox3d box(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff());
        return box.exteriorDistance(point) > distance * (1 + kMaxRoundings * kDoubleRoundoff);
    });
    std::ranges::sort(found);
    return found;
}

} // namespace fettle::mesh
