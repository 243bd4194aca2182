#pragma once

#include "core/uninitialized_vector.h"
#include "mesh/lanes.h"
#include "mesh/mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace fettle::mesh {

// Bound on the number of float operations in a distance or a ray-box intersection. Each adds a rounding error of at
// most kFloatRoundoff times the distance.
inline constexpr double kMaxRoundings = 16;
// Relative error of a distance to a box or disc. Boxes and discs are enlarged by this share of their largest
// coordinate, which covers the rounding of their triangles' coordinates, too.
inline constexpr float kBoundRoundingError = static_cast<float>(4 * kMaxRoundings * kFloatRoundoff);

/// Eight axis-aligned boxes. An empty box has its minimum at +infinity, at infinite distance from every point.
struct Boxes8 {
    Float8 min[3], max[3];
};

/// Eight flat cylinders, each the bounding volume of a child's triangles. Where a surface is flat and oblique they are
/// much tighter than boxes, so a search from afar visits fewer children.
struct Discs8 {
    Float8 centre[3], normal[3], radius;
    Float8 half_thickness; ///< thickness / 2
};

/// All nodes of the same height in the tree.
struct TreeLevel {
    core::UninitializedVector<Boxes8> boxes;
    core::UninitializedVector<Discs8> discs; ///< empty at levels whose children are too large to be flat
};

/// Eight triangles; the indices of `corner` are corner and axis.
struct Triangles8 {
    Float8 corner[3][3];
};
FETTLE_INLINE Point8 corner(const Triangles8& t, int k) { return {t.corner[k][0], t.corner[k][1], t.corner[k][2]}; }

FETTLE_INLINE Boxes8 boxes_of(const Triangles8& triangles)
{
    const auto& [a, b, c] = triangles.corner;
    Boxes8 boxes;
    for (int axis = 0; axis < 3; ++axis) {
        boxes.min[axis] = cwise_min(a[axis], cwise_min(b[axis], c[axis]));
        boxes.max[axis] = cwise_max(a[axis], cwise_max(b[axis], c[axis]));
    }
    return boxes;
}

/// The boxes enlarged by `margin` on all sides.
FETTLE_INLINE Boxes8 enlarged(Boxes8 boxes, float margin)
{
    for (int axis = 0; axis < 3; ++axis) {
        boxes.min[axis] -= margin;
        boxes.max[axis] += margin;
    }
    return boxes;
}

/// Eight triangles in 18 bytes each. A corner's coordinate is origin + step · number: the origin is the lowest corner
/// of the triangles' bounding box, and kMaxNumber steps are its longest side.
struct PackedTriangles8 {
    static constexpr std::uint16_t kMaxNumber = std::numeric_limits<std::uint16_t>::max();
    using Number8 = std::uint16_t __attribute__((vector_size(16), aligned(2)));

    Number8 corner[3][3]; ///< the indices are corner and axis
    float origin[3], step;
};

FETTLE_INLINE Float8 to_float(PackedTriangles8::Number8 numbers)
{
    // GCC converts to int in two halves, and a shuffle that puts zeros between the numbers in one instruction.
    const auto widened = __builtin_shufflevector(numbers, PackedTriangles8::Number8{}, //
                                                 0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15);
    return __builtin_convertvector(std::bit_cast<Mask8>(widened), Float8);
}

/// The triangles relative to the origin of their numbers.
FETTLE_INLINE Triangles8 unpack_at_origin(const PackedTriangles8& packed)
{
    Triangles8 triangles;
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k) triangles.corner[k / 3][k % 3] = to_float(packed.corner[k / 3][k % 3]) * packed.step;
    return triangles;
}

/// The triangles relative to the tree's centre.
FETTLE_INLINE Triangles8 unpack(const PackedTriangles8& packed)
{
    Triangles8 triangles = unpack_at_origin(packed);
#pragma GCC unroll 3
    for (auto& corner : triangles.corner)
        for (int axis = 0; axis < 3; ++axis) corner[axis] += packed.origin[axis];
    return triangles;
}

/// Bound on the distance from a corner to where unpack_at_origin() puts it, mm: √3 times half a step and .02 of it, for
/// five roundings of numbers up to 2^16 in float, one of them of a point that is moved to the origin.
FETTLE_INLINE float packing_error(const PackedTriangles8& packed) { return 0.91f * packed.step; }

/// Margin by which what is measured of unpack() is uncertain, mm: the packing's and kBoundRoundingError of the largest
/// coordinate.
FETTLE_INLINE float margin(const PackedTriangles8& packed)
{
    const auto& [x, y, z] = packed.origin;
    const float far = std::max({std::abs(x), std::abs(y), std::abs(z)}) + PackedTriangles8::kMaxNumber * packed.step;
    return packing_error(packed) + kBoundRoundingError * far;
}

/// Bounding volume hierarchy over the triangles of a mesh, eight triangles to a leaf and eight children to a node: a
/// packed tree without pointers (Kamel & Faloutsos, On packing R-trees, 1993), in the order of a k-d tree. Node i of
/// level l holds the bounds of its children, nodes 8 i to 8 i + 7 of level l - 1, or leaves for level 0; the last level
/// is the root alone. Coordinates are floats relative to `centre`, where floats are finest. Each is rounded by
/// kFloatRoundoff of itself, so that a few triangles far off are rough and the others are not.
struct BoxTree {
    explicit BoxTree(const Mesh& mesh);

    /// Index in the mesh of the triangle in a lane of a leaf.
    Eigen::Index triangle(std::uint32_t leaf, std::uint32_t lane) const
    {
        return triangle_order[std::min(std::size_t{8} * leaf + lane, triangle_order.size() - 1)];
    }

    Eigen::AlignedBox3d box;                                 ///< bounding box of the mesh, mm
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();        ///< median of the vertices by axis, of a sample of them
    core::UninitializedVector<std::uint32_t> triangle_order; ///< at 8 l + k the index of triangle k of leaf l
    core::UninitializedVector<PackedTriangles8> leaves;      ///< the last is filled up with copies of the last triangle
    std::vector<TreeLevel> levels;
};

} // namespace fettle::mesh
