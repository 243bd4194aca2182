#pragma once

#include "belt/charts.h"
#include "compare/reference_mesh.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::belt {

/// A half-edge mesh that represents a piecewise smooth surface with sharp edges. Half-edge 3 f + k runs from corner k
/// of facet f to the next corner; the same number denotes the corner.
struct DesignMesh {
    compare::ReferenceMesh reference;
    Eigen::Matrix3Xd facet_normals;  ///< unit; zero for a facet without area
    Eigen::VectorXd areas;           ///< of the facets, mm²
    Eigen::Matrix3Xd corner_normals; ///< column 3 f + k: unit normal of the smooth surface at that corner
    std::vector<int> twins;          ///< opposite half-edges; -1: none, at a border or where more than two facets meet
    std::vector<bool> sharp; ///< half-edges without a twin, or with more than the sharp angle between the facets
    Adjacency adjacency;     ///< of facets across edges that are not sharp

    Eigen::Vector3d corner(int half_edge) const
    {
        return reference.mesh.vertices.col(reference.mesh.triangles(half_edge % 3, half_edge / 3));
    }
};

/// @param sharp_angle  between the normals of two facets, rad: above it their edge is sharp
DesignMesh design_mesh(mesh::Mesh mesh, double sharp_angle);

/// Boundaries of the smooth pieces: closed loops of consecutive sharp half-edges, with the piece on their left.
std::vector<std::vector<int>> sharp_loops(const DesignMesh& design);

} // namespace fettle::belt
