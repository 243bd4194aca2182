#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle {

/// Twelve facets, outwards. @param half  of a side, mm
inline mesh::Mesh cube(double half, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero())
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 8);
    for (int i = 0; i < 8; ++i)
        mesh.vertices.col(i) = centre + half * Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    mesh.triangles.resize(3, 12);
    mesh.triangles.transpose() << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6,
        2, 1, 3, 7, 1, 7, 5;
    return mesh;
}

} // namespace fettle
