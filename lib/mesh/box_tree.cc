#include "mesh/box_tree.h"

#include "core/parallel_box.h"
#include "core/simd.h"
#include "geometry/stray_point.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

namespace fettle::mesh {

namespace {

constexpr std::size_t kBranching = 8; // children of a node, triangles of a leaf

// Number of levels that have discs. Children of the next level hold 512 triangles, which on most parts are not flat.
constexpr std::size_t kDiscLevels = 2;

/// An axis-aligned box, empty at first. (Eigen's empty AlignedBox3f has finite corners, see Boxes8.)
struct Box {
    Eigen::Array3f min = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f max = -min;
};

void set(Boxes8& boxes, std::size_t k, const Box& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        boxes.min[axis][k] = box.min[axis];
        boxes.max[axis][k] = box.max[axis];
    }
}

Box box_of(const Boxes8& boxes)
{
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = min_lane(boxes.min[axis]);
        box.max[axis] = max_lane(boxes.max[axis]);
    }
    return box;
}

/// Bounding box of the triangles as they are, not as they are packed.
FETTLE_CLONES Box box_of(const PackedTriangles8& packed)
{
    Box box = box_of(boxes_of(unpack(packed)));
    box.min -= packing_error(packed);
    box.max += packing_error(packed);
    return box;
}

Box box_of(const Boxes8& boxes, std::size_t k)
{
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = boxes.min[axis][k];
        box.max[axis] = boxes.max[axis][k];
    }
    return box;
}

float max_coordinate(const Box& box) { return box.min.abs().max(box.max.abs()).maxCoeff(); }

/// The box enlarged by the margin that kBoundRoundingError asks for. An empty box stays empty.
Box enlarged(Box box)
{
    if (!(box.min[0] <= box.max[0])) return box;
    const float margin = kBoundRoundingError * max_coordinate(box);
    box.min -= margin;
    box.max += margin;
    return box;
}

/// The triangles in the nearest steps.
FETTLE_CLONES PackedTriangles8 packed(const Triangles8& triangles)
{
    const Box box = box_of(boxes_of(triangles));
    constexpr float kMaxNumber = PackedTriangles8::kMaxNumber;
    PackedTriangles8 result;
    Eigen::Array3f::Map(result.origin) = box.min;
    // A denormal step would lose its digits; below it all corners are the origin.
    result.step = std::max((box.max - box.min).maxCoeff() / kMaxNumber, std::numeric_limits<float>::min());
    for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 steps = (triangles.corner[c][axis] - box.min[axis]) / result.step + 0.5f;
            result.corner[c][axis] = __builtin_convertvector(
                __builtin_convertvector(cwise_min(steps, broadcast(kMaxNumber)), Mask8), PackedTriangles8::Number8);
        }
    return result;
}

struct Disc {
    Eigen::Vector3f centre, normal;
    float radius, half;
};

void set(Discs8& discs, std::size_t k, const Disc& disc)
{
    for (int axis = 0; axis < 3; ++axis) {
        discs.centre[axis][k] = disc.centre[axis];
        discs.normal[axis][k] = disc.normal[axis];
    }
    discs.radius[k] = disc.radius;
    discs.half_thickness[k] = disc.half;
}

/// Bounding disc of the triangles of some leaves, normal to the sum of their area vectors.
/// @param box  bounding box of the leaves
FETTLE_CLONES Disc bounding_disc(std::span<const PackedTriangles8> leaves, const Box& box)
{
    Point8 area = {};
    for (const PackedTriangles8& leaf : leaves) {
        const Triangles8 t = unpack_at_origin(leaf);
        const Point8 a = corner(t, 0);
        area = area + cross(corner(t, 1) - a, corner(t, 2) - a);
    }
    Disc disc;
    disc.normal = Eigen::Vector3f(sum_lanes(area.x), sum_lanes(area.y), sum_lanes(area.z)).stableNormalized();
    if (!(disc.normal.norm() > 0.5f)) disc.normal = Eigen::Vector3f::UnitZ(); // the areas cancel: any direction will do
    const Eigen::Vector3f middle = (box.min + box.max) / 2;
    const Point8 normal = broadcast(disc.normal.data()), origin = broadcast(middle.data());
    Float8 lowest = broadcast(std::numeric_limits<float>::infinity()), highest = -lowest, radial2 = {};
    float rounding = kBoundRoundingError * max_coordinate(box);
    for (const PackedTriangles8& leaf : leaves) {
        const Triangles8 t = unpack(leaf);
        rounding = std::max(rounding, margin(leaf));
        for (int k = 0; k < 3; ++k) {
            const Point8 from_middle = corner(t, k) - origin;
            const Float8 axial = dot(from_middle, normal);
            lowest = cwise_min(lowest, axial);
            highest = cwise_max(highest, axial);
            radial2 = cwise_max(radial2, dot(from_middle, from_middle) * (1 + kBoundRoundingError) - axial * axial);
        }
    }
    const float low = min_lane(lowest), high = max_lane(highest);
    disc.centre = middle + disc.normal * ((low + high) / 2);
    disc.radius = std::sqrt(max_lane(radial2)) + rounding;
    disc.half = (high - low) / 2 + rounding;
    return disc;
}

Eigen::AlignedBox3d box_of(const Mesh& mesh)
{
    return core::parallel_bounding_box(mesh.triangles.cols(), [&](Eigen::AlignedBox3d& box, std::size_t t) {
        for (const int corner : mesh.triangles.col(t)) box.extend(mesh.vertices.col(corner));
    });
}

/// The level above `children`, with their boxes, eight to a node.
template <typename Child>
TreeLevel level_over(std::span<const Child> children)
{
    TreeLevel level;
    level.boxes.resize((children.size() + kBranching - 1) / kBranching);
    tbb::parallel_for(std::size_t{0}, level.boxes.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < kBranching; ++k)
            set(level.boxes[i], k,
                kBranching * i + k < children.size() ? enlarged(box_of(children[kBranching * i + k])) : Box{});
    });
    return level;
}

/// Adds the discs of the children of a level.
/// @param leaves_per_child  the last child may have fewer
void add_discs(TreeLevel& level, std::span<const PackedTriangles8> leaves, std::size_t leaves_per_child)
{
    level.discs.resize(level.boxes.size());
    tbb::parallel_for(std::size_t{0}, level.discs.size(), [&](std::size_t i) {
        level.discs[i] = Discs8{};
        for (std::size_t k = 0; k < kBranching; ++k) {
            const std::size_t first = std::min((kBranching * i + k) * leaves_per_child, leaves.size());
            const std::size_t count = std::min(leaves_per_child, leaves.size() - first);
            if (count == 0) break;
            set(level.discs[i], k, bounding_disc(leaves.subspan(first, count), box_of(level.boxes[i], k)));
        }
    });
}

/// A triangle as the tree sorts it.
struct Item {
    std::array<float, 3> centroid; ///< mean of the corners
    std::uint32_t triangle;
};

/// Moves the items that satisfy the predicate to the front. No branch depends on the data, unlike in std::partition:
/// the processor would mispredict half of them.
/// @return  number of such items
template <typename Predicate>
std::size_t branchless_partition(std::span<Item> range, const Predicate& predicate)
{
    std::size_t count = 0;
    for (Item& next : range) {
        const Item item = next;
        next = range[count];
        range[count] = item;
        count += predicate(item);
    }
    return count;
}

/// Estimates from a sample the coordinate below which the `count` lowest items lie.
float estimate_pivot(std::span<const Item> range, std::size_t count, std::size_t axis)
{
    std::array<float, 63> sample;
    const std::size_t size = std::clamp<std::size_t>(range.size() / 16 | 1, 3, sample.size());
    for (std::size_t i = 0; i < size; ++i) sample[i] = range[(2 * i + 1) * range.size() / (2 * size)].centroid[axis];
    const auto pivot = sample.begin() + count * size / range.size();
    std::nth_element(sample.begin(), pivot, sample.begin() + size);
    return *pivot;
}

/// Moves the `count` lowest items along an axis to the front: quickselect (Hoare, Algorithm 65: FIND, 1961).
void select_lowest(std::span<Item> range, std::size_t count, std::size_t axis)
{
    while (count > 0 && count < range.size()) {
        const float pivot = estimate_pivot(range, count, axis);
        const std::size_t below =
            branchless_partition(range, [&](const Item& item) { return item.centroid[axis] < pivot; });
        if (count <= below) {
            range = range.first(below);
            continue;
        }
        range = range.subspan(below);
        count -= below;
        const std::size_t equal =
            branchless_partition(range, [&](const Item& item) { return item.centroid[axis] <= pivot; });
        if (count <= equal || equal == 0) return; // none is equal: the pivot is NaN, and any order will do
        range = range.subspan(equal);
        count -= equal;
    }
}

/// Axis along which the centroids extend farthest.
std::size_t longest_axis(std::span<const Item> range)
{
    Eigen::Array4f min = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity()), max = -min;
    for (const Item& item : range) { // loads all 16 bytes at once; the fourth lane, the triangle, is ignored
        Eigen::Array4f lanes;
        std::memcpy(lanes.data(), &item, sizeof lanes);
        min = min.min(lanes);
        max = max.max(lanes);
    }
    int axis = 0;
    (max - min).head<3>().maxCoeff(&axis);
    return axis;
}

/// Sorts the items so that those of each subtree are contiguous. The range is split across its longest axis, at a whole
/// number of the largest subtrees that fit in it, until it fits a leaf.
void sort_by_subtree(std::span<Item> range)
{
    if (range.size() <= kBranching) return;
    std::size_t subtree = kBranching;
    while (subtree * kBranching < range.size()) subtree *= kBranching;
    const std::size_t half = std::max((range.size() / 2 + subtree / 2) / subtree, std::size_t{1}) * subtree;
    select_lowest(range, half, longest_axis(range));
    const auto lower = [&] { sort_by_subtree(range.first(half)); };
    const auto upper = [&] { sort_by_subtree(range.subspan(half)); };
    constexpr std::size_t kMinParallelItems = 1 << 13; // a task for fewer costs more than it saves
    if (range.size() > kMinParallelItems) {
        tbb::parallel_invoke(lower, upper);
    } else {
        lower();
        upper();
    }
}

/// Indices of the triangles in the order of the leaves.
core::UninitializedVector<std::uint32_t> leaf_order(const Mesh& mesh, const Eigen::Vector3d& centre)
{
    core::UninitializedVector<Item> items(mesh.triangles.cols());
    tbb::parallel_for(std::size_t{0}, items.size(), [&](std::size_t t) {
        const Eigen::Vector3i corners = mesh.triangles.col(t);
        const Eigen::Vector3d sum =
            mesh.vertices.col(corners[0]) + mesh.vertices.col(corners[1]) + mesh.vertices.col(corners[2]);
        Eigen::Vector3f::Map(items[t].centroid.data()) = (sum / 3 - centre).cast<float>();
        items[t].triangle = static_cast<std::uint32_t>(t);
    });
    sort_by_subtree(items);
    core::UninitializedVector<std::uint32_t> order(items.size());
    tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) { order[i] = items[i].triangle; });
    return order;
}

} // namespace

BoxTree::BoxTree(const Mesh& mesh) : box(box_of(mesh))
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    if (count == 0) return;
    centre = geometry::sampled_median(mesh.vertices);
    triangle_order = leaf_order(mesh, centre);
    leaves.resize((count + kBranching - 1) / kBranching);
    tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t l) {
        Triangles8 triangles;
        for (std::size_t k = 0; k < kBranching; ++k) {
            const std::uint32_t t = triangle_order[std::min(kBranching * l + k, count - 1)];
            for (int c = 0; c < 3; ++c) {
                const Eigen::Vector3f position = (mesh.vertices.col(mesh.triangles(c, t)) - centre).cast<float>();
                for (int axis = 0; axis < 3; ++axis) triangles.corner[c][axis][k] = position[axis];
            }
        }
        leaves[l] = packed(triangles);
    });
    levels.push_back(level_over<PackedTriangles8>(leaves));
    while (levels.back().boxes.size() > 1) levels.push_back(level_over<Boxes8>(levels.back().boxes));
    std::size_t leaves_per_child = 1;
    for (std::size_t l = 0; l < std::min(kDiscLevels, levels.size()); ++l, leaves_per_child *= kBranching)
        add_discs(levels[l], leaves, leaves_per_child);
}

} // namespace fettle::mesh
