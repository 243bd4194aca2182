#include "robot/mesh_clearance.h"

#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "robot/wide_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr float kMaxFloat = std::numeric_limits<float>::max();

/// A node of a tree; at level -1, a leaf.
struct Node {
    std::int32_t level;
    std::uint32_t index;
};

/// Two nodes whose triangles are still to be compared.
struct NodePair {
    float bound; ///< lower bound of their distance, mm
    Node a, b;
};

/// Two triangles that may be the nearest.
struct TrianglePair {
    float lower_bound; ///< of their distance, within rounding
    std::uint32_t leaf_a, lane_a, leaf_b, lane_b;
};

FETTLE_INLINE FlatBox flat_box(const mesh::Boxes8& boxes, unsigned lane)
{
    FlatBox box;
    for (int k = 0; k < 3; ++k) {
        box.centre[k] = (boxes.max[k][lane] + boxes.min[k][lane]) * 0.5f;
        box.half[k] = (boxes.max[k][lane] - boxes.min[k][lane]) * 0.5f;
    }
    return box;
}

FETTLE_INLINE FlatBox box_of(const mesh::BoxTree& tree, const Node& node)
{
    const auto above = static_cast<std::size_t>(node.level + 1);
    if (above < tree.levels.size()) return flat_box(tree.levels[above].boxes[node.index / 8], node.index % 8);
    const mesh::Boxes8& children = tree.levels.back().boxes.front();
    FlatBox box;
    for (int k = 0; k < 3; ++k) {
        const float min = mesh::min_lane(children.min[k]), max = mesh::max_lane(children.max[k]);
        box.centre[k] = (max + min) * 0.5f;
        box.half[k] = (max - min) * 0.5f;
    }
    return box;
}

FETTLE_INLINE float size_of(const FlatBox& box) { return std::max({box.half[0], box.half[1], box.half[2]}); }

/// The largest coordinate of a tree's triangles, mm.
double size_of(const mesh::BoxTree& tree)
{
    return (tree.box.max() - tree.centre).cwiseAbs().cwiseMax((tree.box.min() - tree.centre).cwiseAbs()).maxCoeff();
}

/// The search for the nearest triangles of two meshes.
struct PairSearch {
    PairSearch(const Workpiece& of_a, const Workpiece& of_b, const Isometry3d& placement, NearestTriangles& found)
        : a(of_a), b(of_b), T_b_a(placement), best(found)
    {
    }

    const Workpiece &a, &b;
    const Isometry3d& T_b_a;
    NearestTriangles& best;
    const mesh::BoxTree &tree_a = a.tree(), &tree_b = b.tree();
    const Isometry3d T_trees =
        Eigen::Translation3d(-tree_b.centre) * T_b_a * Eigen::Translation3d(tree_a.centre); ///< from tree a to tree b
    const WideMotion to_b{T_trees}, to_a{T_trees.inverse()};
    /// Error bound of distances in float, mm, but for the margins of boxes and leaves.
    const double rounding = 4 * mesh::kMaxRoundings * mesh::kFloatRoundoff *
                            (size_of(tree_a) + size_of(tree_b) + T_trees.translation().cwiseAbs().maxCoeff());
    /// Upper bound of the minimum distance in float, mm: pairs above it are not nearest in double either.
    float upper_bound = std::min(kMaxFloat, float(best.clearance.distance + 2 * rounding));
    std::array<TrianglePair, 64> candidates;
    std::size_t candidate_count = 0;
    /// Each visited pair is replaced by at most eight, and both trees have at most eleven levels.
    std::array<NodePair, 2 * mesh::kMaxStackSize> stack;
    std::size_t stack_size = 0;

    void set_upper_bound(double distance) { upper_bound = std::min(upper_bound, float(distance + 2 * rounding)); }

    /// Measures the candidates that are still possible in double. The last one, usually the nearest, comes first.
    void refine_candidates()
    {
        while (candidate_count > 0) {
            const TrianglePair& next = candidates[--candidate_count];
            if (next.lower_bound > upper_bound) continue;
            const Eigen::Index of_a = tree_a.triangle(next.leaf_a, next.lane_a),
                               of_b = tree_b.triangle(next.leaf_b, next.lane_b);
            const PlacedSolid first(mesh::Triangle(T_b_a * mesh::triangle_of(a.mesh(), of_a))),
                second(mesh::triangle_of(b.mesh(), of_b));
            const Clearance c = robot::clearance(first, second, best.clearance.distance);
            if (!(c.distance < best.clearance.distance)) continue;
            best = {c, of_a, of_b, false, {next.leaf_a, next.leaf_b}};
            set_upper_bound(c.distance);
        }
    }

    FETTLE_INLINE void scan_leaves(std::uint32_t leaf_a, std::uint32_t leaf_b)
    {
        const mesh::PackedTriangles8 &packed_a = tree_a.leaves[leaf_a], &packed_b = tree_b.leaves[leaf_b];
        const float margin = mesh::margin(packed_a) + mesh::margin(packed_b);
        // Relative to the origin of b's numbers.
        const mesh::Triangles8 of_a = unpack_at_origin(packed_a), of_b = unpack_at_origin(packed_b);
        const WideMotion motion = to_b.between(packed_a.origin, packed_b.origin);
        mesh::Triangles8 moved;
        for (int k = 0; k < 3; ++k) {
            const mesh::Point8 p = motion(mesh::corner(of_a, k));
            moved.corner[k][0] = p.x;
            moved.corner[k][1] = p.y;
            moved.corner[k][2] = p.z;
        }
        const mesh::Boxes8 boxes_a = mesh::boxes_of(moved), boxes_b = mesh::boxes_of(of_b);
        const mesh::Point8 corners_b[3] = {mesh::corner(of_b, 0), mesh::corner(of_b, 1), mesh::corner(of_b, 2)};
        for (unsigned lane = 0; lane < 8; ++lane) {
            mesh::Float8 outside2 = {}, highest = mesh::broadcast(-kMaxFloat);
            for (int k = 0; k < 3; ++k) {
                const mesh::Float8 excess = mesh::cwise_max(boxes_a.min[k][lane] - boxes_b.max[k],
                                                            boxes_b.min[k] - boxes_a.max[k][lane]),
                                   off = mesh::cwise_max(excess, mesh::Float8{});
                outside2 += off * off;
                highest = mesh::cwise_max(highest, excess);
            }
            const mesh::Float8 distances =
                mesh::cwise_sqrt(outside2) + mesh::cwise_min(highest, mesh::Float8{}) - margin;
            const mesh::Mask8 near = distances <= upper_bound;
            if (mesh::lane_bits(near) == 0) continue;
            mesh::Point8 corners_a[3];
            for (int k = 0; k < 3; ++k)
                corners_a[k] = {mesh::broadcast(moved.corner[k][0][lane]), mesh::broadcast(moved.corner[k][1][lane]),
                                mesh::broadcast(moved.corner[k][2][lane])};
            TriangleBounds8 bounds = triangle_distances(corners_a, corners_b);
            bounds.lower -= margin;
            bounds.upper += margin;
            if (mesh::lane_bits(bounds.upper < upper_bound) != 0) set_upper_bound(mesh::min_lane(bounds.upper));
            for (mesh::LaneIterator lanes{mesh::lane_bits(near & (bounds.lower <= upper_bound))}; lanes.any();
                 lanes.next()) {
                if (candidate_count == candidates.size()) refine_candidates();
                candidates[candidate_count++] = {bounds.lower[lanes.first()], leaf_a, lane, leaf_b, lanes.first()};
            }
        }
    }

    /// Pushes the pairs of a node and the children of another, so that the nearest is popped first.
    FETTLE_INLINE void push(const mesh::Float8& bounds, const Node& parent, const Node& other, bool of_a)
    {
        const std::size_t first = stack_size;
        for (mesh::LaneIterator left{mesh::lane_bits(bounds <= upper_bound)}; left.any(); left.next()) {
            const float bound = bounds[left.first()];
            const Node child = {parent.level - 1, 8 * parent.index + left.first()};
            std::size_t position = stack_size++;
            for (; position > first && stack[position - 1].bound < bound; --position)
                stack[position] = stack[position - 1];
            stack[position] = of_a ? NodePair{bound, child, other} : NodePair{bound, other, child};
        }
    }

    FETTLE_INLINE void run()
    {
        const LeafPair start = {std::min(best.leaves.a, std::uint32_t(tree_a.leaves.size()) - 1),
                                std::min(best.leaves.b, std::uint32_t(tree_b.leaves.size()) - 1)};
        scan_leaves(start.a, start.b);
        refine_candidates();
        stack[stack_size++] = {
            -kMaxFloat, {std::int32_t(tree_a.levels.size()) - 1, 0}, {std::int32_t(tree_b.levels.size()) - 1, 0}};
        while (stack_size > 0) {
            const NodePair next = stack[--stack_size];
            if (next.bound > upper_bound) continue;
            if (next.a.level < 0 && next.b.level < 0) {
                if (next.a.index != start.a || next.b.index != start.b) scan_leaves(next.a.index, next.b.index);
                continue;
            }
            const FlatBox box_a = box_of(tree_a, next.a), box_b = box_of(tree_b, next.b);
            const bool split_a = next.b.level < 0 || (next.a.level >= 0 && size_of(box_a) > size_of(box_b));
            if (split_a)
                push(box_distances(tree_a.levels[next.a.level].boxes[next.a.index], box_b, to_a), next.a, next.b, true);
            else
                push(box_distances(tree_b.levels[next.b.level].boxes[next.b.index], box_a, to_b), next.b, next.a,
                     false);
        }
        refine_candidates();
    }
};

// Functions with clones for several processors cannot be templates.
FETTLE_CLONES void run(PairSearch& search) { search.run(); }

/// The width of a mesh along a direction, mm.
double width_along(const mesh::Mesh& mesh, const Vector3d& direction)
{
    const Eigen::RowVectorXd along = direction.transpose() * mesh.vertices;
    return along.maxCoeff() - along.minCoeff();
}

} // namespace

NearestTriangles nearest_triangles(const Workpiece& a, const Workpiece& b, const Isometry3d& T_b_a, double max_distance,
                                   LeafPair start)
{
    NearestTriangles best;
    best.clearance.distance = max_distance;
    best.leaves = start;
    if (a.tree().leaves.empty() || b.tree().leaves.empty()) return best;
    PairSearch search(a, b, T_b_a, best);
    run(search);
    if (best.triangle_a >= 0 && best.clearance.distance <= 0) return best;
    // Surfaces that do not touch: any point of a mesh that lies inside the other says that all do.
    const bool a_inside = b.contains(T_b_a * mesh::triangle_of(a.mesh(), 0).col(0));
    if (!a_inside && !a.contains(T_b_a.inverse() * mesh::triangle_of(b.mesh(), 0).col(0))) return best;
    if (best.triangle_a < 0) // the depth exceeds max_distance: measured without that bound
        return nearest_triangles(a, b, T_b_a, std::numeric_limits<double>::infinity(), start);
    const Vector3d& n = best.clearance.normal;
    const double width = a_inside ? width_along(a.mesh(), T_b_a.linear().transpose() * n) : width_along(b.mesh(), n);
    best.inside = true;
    make_penetration(best.clearance, width);
    return best;
}

} // namespace fettle::robot
