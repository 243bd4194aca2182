#pragma once

#include "belt/charts.h"
#include "compare/reference_mesh.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// A mesh as a smooth surface with sharp edges. Half-edge 3 f + k leads from corner k of facet f to the next.
struct DesignMesh {
    ReferenceMesh reference;
    Eigen::Matrix3Xd facet_normals;  ///< unit; zero for a facet without area
    Eigen::VectorXd areas;           ///< of the facets, mm²
    Eigen::Matrix3Xd corner_normals; ///< column 3 f + k: unit, of the smooth surface at corner k of facet f
    std::vector<int> twins;          ///< of half-edges; -1: none, the surface ends there or more than two facets meet
    std::vector<bool> sharp;         ///< half-edges without twin, or where the normals turn by more than an angle
    Adjacency adjacency;             ///< of facets over edges that are not sharp

    Eigen::Vector3d corner(int half_edge) const
    {
        return reference.mesh.vertices.col(reference.mesh.triangles(half_edge % 3, half_edge / 3));
    }
};

/// @param angle  rad; between two normals, more is an edge
DesignMesh design_mesh(Mesh mesh, double angle);

/// Around the boundaries of its smooth pieces: closed loops of sharp half-edges, each following the one before around
/// their vertex, with the piece on the left.
std::vector<std::vector<int>> sharp_loops(const DesignMesh& design);

} // namespace fettle
