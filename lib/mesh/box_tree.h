#pragma once

#include "core/large_array.h"
#include "mesh/lanes.h"
#include "mesh/mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fettle {

// Operations in float on the way to a distance, or to where a ray meets a box, are fewer than this, each off by a
// rounding of numbers no larger than the way.
inline constexpr double kRoundings = 16;
// The same for making a disc and finding the way to it, of coordinates of the mesh and of the way.
inline constexpr float kDiscRoundings = static_cast<float>(4 * kRoundings * kEpsilon);

/// Eight boxes; one that is not there has its least corner at +infinity and is far from everything.
struct Boxes8 {
    Float8 least[3], most[3];
};

/// Eight flat cylinders, each about the triangles of a child. Where a surface is flat they lie closer to it than boxes
/// do: from afar few of them seem to be nearest.
struct Discs8 {
    Float8 centre[3], normal[3], radius;
    Float8 half; ///< of the thickness
};

/// Nodes that are equally far from the leaves.
struct Level {
    LargeArray<Boxes8> boxes;
    LargeArray<Discs8> discs; ///< none where the children are too large to be flat
};

/// Eight triangles: coordinates of their corners.
struct Triangles8 {
    Float8 corner[3][3]; ///< corner, axis
};
FETTLE_INLINE Point8 corner(const Triangles8& t, int k) { return {t.corner[k][0], t.corner[k][1], t.corner[k][2]}; }

/// The triangles of a mesh, eight to a leaf, eight leaves or nodes to a node: a packed tree without pointers (Kamel &
/// Faloutsos, On packing R-trees, 1993), in the order of a k-d tree. Node i of level l holds the bounds of its
/// children, nodes 8 i to 8 i + 7 of level l - 1, or leaves for level 0; the last level is the root alone.
/// Coordinates are floats about `centre`, where floats are finest; each is off by no more than `rounding`.
struct BoxTree {
    explicit BoxTree(const Mesh& mesh);

    Eigen::Index triangle(std::uint32_t leaf, std::uint32_t lane) const
    {
        return order[std::min(std::size_t{8} * leaf + lane, order.size() - 1)];
    }

    Eigen::AlignedBox3d box;                          ///< of the mesh
    Eigen::Vector3d centre = Eigen::Vector3d::Zero(); ///< of the box
    double rounding = 0;                              ///< of a coordinate, mm
    LargeArray<std::uint32_t> order; ///< of the mesh's triangles; triangle k of leaf l is order[8 l + k]
    LargeArray<Triangles8> leaves;   ///< where there is none, the last triangle stands again
    std::vector<Level> levels;
};

} // namespace fettle
