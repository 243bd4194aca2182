#include "mesh/mesh_index.h"

#include "core/simd.h"
#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

// The tree and a first look at triangles are in float; whatever a rounding might have hidden is looked at in double.

namespace fettle {

namespace {

Triangle triangle_of(const Mesh& mesh, Eigen::Index index)
{
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, index));
    return corners;
}

constexpr Eigen::Index kNone = std::numeric_limits<Eigen::Index>::max(); // any triangle has a lower index

/// A triangle that may be the nearest.
struct Candidate {
    float least; ///< squared distance
    std::uint32_t leaf, lane;
};

/// The nearest triangle so far, and how near others must be to matter.
struct Nearest {
    /// @param roundings  of the way from the point to a box or triangle, mm
    Nearest(const Eigen::Vector3d& asked, const Eigen::Vector3d& about_centre, double radius, double roundings)
        : point(asked), rounding(roundings)
    {
        Eigen::Vector3f::Map(place) = about_centre.cast<float>();
        found.squared_distance = radius * radius;
        set_bound(radius);
    }

    const Eigen::Vector3d& point;
    float place[3]; ///< of the point, about the tree's centre
    double rounding;
    TrianglePoint found;
    Eigen::Index triangle = kNone;
    std::uint32_t leaf = 0;
    float bound = std::numeric_limits<float>::max(); ///< squared; nearer than a box that is not there
    std::array<Candidate, 64> candidates;            ///< the first few of them wait, hardly ever more than six
    std::size_t waiting = 0;

    /// A triangle is known to be no farther than this.
    void set_bound(double distance)
    {
        const double far = (distance + rounding) * (1 + kRoundings * kEpsilon);
        if (far * far < bound) bound = static_cast<float>(far * far);
    }

    void offer(const Triangle& corners, Eigen::Index index, std::uint32_t in_leaf)
    {
        const TrianglePoint other = closest_on_triangle(corners, point);
        if (other.squared_distance > found.squared_distance) return;
        if (other.squared_distance == found.squared_distance && index >= triangle) return;
        found = other;
        triangle = index;
        leaf = in_leaf;
        set_bound(std::sqrt(found.squared_distance));
    }
};

/// Measures the candidates that still matter, in double: the last ones, the nearest as a rule, first.
void settle(Nearest& nearest, const BoxTree& tree, const Mesh& mesh)
{
    while (nearest.waiting > 0) {
        const Candidate& next = nearest.candidates[--nearest.waiting];
        if (next.least > nearest.bound) continue;
        const Eigen::Index t = tree.triangle(next.leaf, next.lane);
        nearest.offer(triangle_of(mesh, t), t, next.leaf);
    }
}

/// Looks for candidates in a leaf, in float.
FETTLE_INLINE void look_through(std::uint32_t leaf, Nearest& nearest, const BoxTree& tree, const Mesh& mesh)
{
    const Bounds8 distances = squared_distances(tree.leaves[leaf], nearest.place);
    if (lanes_of(distances.most < nearest.bound) != 0)
        nearest.set_bound(std::sqrt(static_cast<double>(least_of(distances.most))) + nearest.rounding);
    for (Lanes lanes{lanes_of(distances.least <= nearest.bound)}; lanes.any(); lanes.next()) {
        if (nearest.waiting == nearest.candidates.size()) settle(nearest, tree, mesh);
        nearest.candidates[nearest.waiting++] = {distances.least[lanes.first()], leaf, lanes.first()};
    }
}

/// Goes through what waits.
FETTLE_INLINE void go_through(Stack& stack, Nearest& nearest, const BoxTree& tree, const Mesh& mesh)
{
    while (stack.any()) {
        const Waiting next = stack.pop();
        if (next.distance > nearest.bound) continue;
        if (next.level < 0) {
            look_through(next.index, nearest, tree, mesh);
            continue;
        }
        const Float8 children =
            squared_distance(tree.levels[static_cast<std::size_t>(next.level)], next.index, nearest.place);
        stack.push(lanes_of(children <= nearest.bound), children, next.level - 1, next.index);
    }
}

/// From a leaf that is probably near upwards: of most nodes above it no other child is near enough.
FETTLE_CLONES void find(Nearest& nearest, std::uint32_t leaf, const BoxTree& tree, const Mesh& mesh)
{
    look_through(leaf, nearest, tree, mesh);
    Stack stack;
    std::uint32_t child = leaf;
    for (std::size_t level = 0; level < tree.levels.size(); ++level) {
        const std::uint32_t node = child / 8;
        const Float8 children = squared_distance(tree.levels[level], node, nearest.place);
        const unsigned others = lanes_of(children <= nearest.bound) & ~(1u << child % 8);
        stack.push(others, children, static_cast<std::int32_t>(level) - 1, node);
        go_through(stack, nearest, tree, mesh);
        child = node;
    }
    settle(nearest, tree, mesh);
}

/// The first hit so far of a ray, and the ray as the tree sees it.
struct FirstHit {
    WatertightRay ray;
    float origin[3];  ///< where the ray enters the box of the mesh, about the tree's centre
    float inverse[3]; ///< of the direction
    double entry;     ///< distance at which that is
    float rounding;   ///< by which boxes are wider
    double distance = std::numeric_limits<double>::infinity();
    Eigen::Index triangle = kNone;
    float bound = std::numeric_limits<float>::infinity(); ///< from the entry on

    void offer(const Triangle& corners, Eigen::Index index)
    {
        const std::optional<double> hit = ray.hit(corners);
        if (!hit || *hit > distance || (*hit == distance && index >= triangle)) return;
        distance = *hit;
        triangle = index;
        bound = static_cast<float>((distance - entry) * (1 + kRoundings * kEpsilon)) + rounding;
    }
};

/// Where a ray enters eight boxes, from its origin on; infinite for those that it misses.
FETTLE_INLINE Float8 entries(const Boxes8& boxes, const FirstHit& hit)
{
    Float8 near = {}, far = all(hit.bound);
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 to_least = (boxes.least[axis] - hit.rounding - hit.origin[axis]) * hit.inverse[axis];
        const Float8 to_most = (boxes.most[axis] + hit.rounding - hit.origin[axis]) * hit.inverse[axis];
        near = larger(near, smaller(to_least, to_most));
        far = smaller(far, larger(to_least, to_most));
    }
    // A box that is not there ends before it begins: as a slab, that is the whole line.
    const Mask8 there = boxes.least[0] <= boxes.most[0];
    return ((near <= far) & there) ? near : all(std::numeric_limits<float>::infinity());
}

FETTLE_INLINE Boxes8 boxes_of(const Triangles8& triangles)
{
    const auto& [a, b, c] = triangles.corner;
    Boxes8 boxes;
    for (int axis = 0; axis < 3; ++axis) {
        boxes.least[axis] = smaller(a[axis], smaller(b[axis], c[axis]));
        boxes.most[axis] = larger(a[axis], larger(b[axis], c[axis]));
    }
    return boxes;
}

FETTLE_CLONES void find(FirstHit& hit, const BoxTree& tree, const Mesh& mesh)
{
    const auto met = [](const Float8& entry) { return lanes_of(entry < std::numeric_limits<float>::infinity()); };
    Stack stack;
    stack.push({0, static_cast<std::int32_t>(tree.levels.size()) - 1, 0});
    while (stack.any()) {
        const Waiting next = stack.pop();
        if (next.distance > hit.bound) continue;
        if (next.level >= 0) {
            const Float8 children = entries(tree.levels[static_cast<std::size_t>(next.level)].boxes[next.index], hit);
            stack.push(met(children), children, next.level - 1, next.index);
            continue;
        }
        for (Lanes lanes{met(entries(boxes_of(tree.leaves[next.index]), hit))}; lanes.any(); lanes.next()) {
            const Eigen::Index t = tree.triangle(next.index, lanes.first());
            hit.offer(triangle_of(mesh, t), t);
        }
    }
}

/// Distance from `origin` to where the ray enters the box; nothing if it misses it.
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
    const double slack = kRoundings * (tree.rounding + kEpsilon * tree.box.sizes().maxCoeff());
    Eigen::AlignedBox3d box = tree.box;
    box.min().array() -= slack;
    box.max().array() += slack;
    const std::optional<double> entry = entry_distance(box, origin, unit_direction);
    if (!entry) return std::nullopt;
    FirstHit hit{WatertightRay(origin, unit_direction), {}, {}, *entry, static_cast<float>(slack)};
    const Eigen::Vector3d start = origin + *entry * unit_direction - tree.centre;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kAcross = 1e-30; // instead of 0, whose inverse times 0 is no number
        const double way = unit_direction[axis];
        hit.origin[axis] = static_cast<float>(start[axis]);
        hit.inverse[axis] = static_cast<float>(1 / (std::abs(way) > kAcross ? way : kAcross));
    }
    find(hit, tree, state_->mesh);
    if (hit.triangle == kNone) return std::nullopt;
    return Hit{hit.distance, hit.triangle, origin + hit.distance * unit_direction};
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
    const Eigen::Vector3d place = point - tree.centre;
    const double rounding = 2 * (tree.rounding + kEpsilon * place.cwiseAbs().maxCoeff()); // 2 > sqrt(3): of three axes
    Nearest nearest(point, place, radius, rounding);
    find(nearest, std::min<std::uint32_t>(leaf, static_cast<std::uint32_t>(tree.leaves.size()) - 1), tree,
         state_->mesh);
    if (nearest.triangle == kNone) return std::nullopt;
    return Closest{nearest.found.point, nearest.triangle, nearest.found.barycentric, nearest.leaf};
}

} // namespace fettle
