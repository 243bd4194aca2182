#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fettle {

/// Eight numbers side by side, anywhere in memory. A comparison gives Mask8: all bits set where it holds, never for
/// NaN.
using Float8 = float __attribute__((vector_size(32), aligned(4)));
using Mask8 = std::int32_t __attribute__((vector_size(32), aligned(4)));

/// Eight boxes; one that is not there has its least corner at +infinity and is far from everything.
struct Boxes8 {
    Float8 least[3], most[3];
};

/// Eight triangles: coordinates of their corners.
struct Triangles8 {
    Float8 corner[3][3]; ///< corner, axis
};

/// The triangles of a mesh, eight to a leaf, eight leaves or nodes to a node: a packed tree without pointers (Kamel &
/// Faloutsos, On packing R-trees, 1993), in the order of a k-d tree. Node i of level l holds the boxes of its
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
    std::vector<std::uint32_t> order; ///< of the mesh's triangles; triangle k of leaf l is order[8 l + k]
    std::vector<Triangles8> leaves;   ///< where there is none, the last triangle stands again
    std::vector<std::vector<Boxes8>> levels;
};

} // namespace fettle
