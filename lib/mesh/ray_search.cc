#include "mesh/ray_search.h"

#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::mesh {

namespace {

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
        const PackedTriangles8& leaf = tree.leaves[node.index];
        const Float8 entries = entry_distances(enlarged(boxes_of(unpack(leaf)), margin(leaf)), query);
        for (LaneIterator lanes{hit_lanes(entries)}; lanes.any(); lanes.next()) {
            const Eigen::Index t = tree.triangle(node.index, lanes.first());
            query.update(triangle_of(mesh, t), t);
        }
    }
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

std::optional<MeshIndex::Hit> first_hit(const BoxTree& tree, const Mesh& mesh, const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& unit_direction)
{
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
    find_first_hit(query, tree, mesh);
    if (query.triangle == kNoTriangle) return std::nullopt;
    return MeshIndex::Hit{query.distance, query.triangle, origin + query.distance * unit_direction};
}

} // namespace fettle::mesh
