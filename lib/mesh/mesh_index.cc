#include "mesh/mesh_index.h"

#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// Branch and bound. Boxes and triangles are first measured in float, eight at a time, with bounds that allow for the
// rounding errors; only the triangles that these bounds cannot exclude are measured in double.

namespace fettle::mesh {

namespace {

/// Means "no triangle yet". It is larger than any index, so that every triangle wins a tie against it.
constexpr Eigen::Index kNoTriangle = std::numeric_limits<Eigen::Index>::max();

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

/// A ray casting query: the ray in double and in float, and the first hit so far.
struct RayQuery {
    WatertightRay ray;
    double reference; ///< distance along the ray to `origin`, mm
    float origin[3];  ///< point of the ray nearest to the tree's centre, relative to it: floats are finest there
    float inverse_direction[3]; ///< componentwise
    float entry;                ///< distance from `origin` to where the ray enters the mesh's bounding box, mm, <= 0
    float padding;              ///< by which boxes are enlarged to allow for the rounding of `origin`, mm
    double distance = std::numeric_limits<double>::infinity();
    Eigen::Index triangle = kNoTriangle;
    float bound = std::numeric_limits<float>::infinity(); ///< of the distance from `origin`, mm

    /// Intersects a triangle in double and keeps the hit if it comes earlier, or equally early with a lower index.
    void update(const Triangle& corners, Eigen::Index index)
    {
        const std::optional<double> hit = ray.hit(corners);
        if (!hit || *hit > distance || (*hit == distance && index >= triangle)) return;
        distance = *hit;
        triangle = index;
        const double offset = distance - reference;
        bound = static_cast<float>(offset + kMaxRoundings * kFloatRoundoff * std::abs(offset)) + padding;
    }
};

/// Distances from `origin` at which a ray enters eight boxes; infinite for boxes that it misses (slab method).
FETTLE_INLINE Float8 entry_distances(const Boxes8& boxes, const RayQuery& query)
{
    Float8 near = broadcast(query.entry), far = broadcast(query.bound);
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 to_min = (boxes.min[axis] - query.padding - query.origin[axis]) * query.inverse_direction[axis];
        const Float8 to_max = (boxes.max[axis] + query.padding - query.origin[axis]) * query.inverse_direction[axis];
        near = cwise_max(near, cwise_min(to_min, to_max));
        far = cwise_min(far, cwise_max(to_min, to_max));
    }
    // The slabs of an empty box, from +infinity to -infinity, would cover the whole ray.
    const Mask8 not_empty = boxes.min[0] <= boxes.max[0];
    return ((near <= far) & not_empty) ? near : broadcast(std::numeric_limits<float>::infinity());
}

FETTLE_CLONES void find_first_hit(RayQuery& query, const BoxTree& tree, const Mesh& mesh)
{
    const auto hit_lanes = [](const Float8& distances) {
        return lane_bits(distances < std::numeric_limits<float>::infinity());
    };
    NodeStack stack;
    stack.push({query.entry, static_cast<std::int32_t>(tree.levels.size()) - 1, 0});
    while (stack.any()) {
        const StackEntry node = stack.pop();
        if (node.distance > query.bound) continue;
        if (node.level >= 0) {
            const Float8 entries = entry_distances(tree.levels[node.level].boxes[node.index], query);
            stack.push(hit_lanes(entries), entries, node.level - 1, node.index);
            continue;
        }
        const Float8 entries =
            entry_distances(enlarged(boxes_of(tree.leaves[node.index]), tree.leaf_margins[node.index]), query);
        for (LaneIterator lanes{hit_lanes(entries)}; lanes.any(); lanes.next()) {
            const Eigen::Index t = tree.triangle(node.index, lanes.first());
            query.update(triangle_of(mesh, t), t);
        }
    }
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
        const Boxes8 boxes = enlarged(boxes_of(tree.leaves[node.index]), tree.leaf_margins[node.index]);
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

/// Distance from `origin` to where the ray enters the box; nothing if it misses the box.
std::optional<double> entry_distance(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction)
{
    double near = 0;
    double far = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < box.min()[axis] || origin[axis] > box.max()[axis]) return std::nullopt;
            continue;
        }
        const double a = (box.min()[axis] - origin[axis]) / direction[axis];
        const double b = (box.max()[axis] - origin[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    if (near > far) return std::nullopt;
    return near;
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
    const BoxTree& tree = state_->tree;
    if (tree.levels.empty() || !origin.allFinite() || !unit_direction.allFinite()) return std::nullopt;
    Eigen::AlignedBox3d box = tree.box;
    const double margin = kBoundRoundingError * box.sizes().maxCoeff();
    box.min().array() -= margin;
    box.max().array() += margin;
    const std::optional<double> entry = entry_distance(box, origin, unit_direction);
    if (!entry) return std::nullopt;
    const double reference = std::max(*entry, (tree.centre - origin).dot(unit_direction));
    const Eigen::Vector3d start = origin + reference * unit_direction - tree.centre;
    const double padding = 2 * kMaxRoundings * kFloatRoundoff * start.cwiseAbs().maxCoeff();
    RayQuery query{WatertightRay(origin, unit_direction),
                   reference,
                   {},
                   {},
                   static_cast<float>(*entry - reference),
                   static_cast<float>(padding)};
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kMinComponent = 1e-30; // in place of 0: the inverse of 0 times 0 would be NaN
        const double component = unit_direction[axis];
        query.origin[axis] = static_cast<float>(start[axis]);
        query.inverse_direction[axis] =
            static_cast<float>(1 / (std::abs(component) > kMinComponent ? component : kMinComponent));
    }
    find_first_hit(query, tree, state_->mesh);
    if (query.triangle == kNoTriangle) return std::nullopt;
    return Hit{query.distance, query.triangle, origin + query.distance * unit_direction};
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
    std::ranges::sort(found);
    return found;
}

} // namespace fettle::mesh
