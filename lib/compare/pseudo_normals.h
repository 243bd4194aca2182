#pragma once

#include "compare/reference_mesh.h"
#include "mesh/mesh_index.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace fettle::compare {

/// Normals that give a point the right sign wherever its closest point on a mesh lies: the normal of the facet, the sum
/// of the two facets' on an edge, the angle-weighted sum on a vertex (Bærentzen & Aanæs, Signed distance computation
/// using the angle weighted pseudonormal, 2005). Facets narrower than the rounding of floats (needles) have no normal;
/// the search continues in their neighbours. Thread-safe.
class PseudoNormals {
  public:
    /// Both must outlive this. @param index  of the mesh, in which the facets at a vertex are searched: a table of them
    /// would take a tenth of the memory
    PseudoNormals(const ReferenceMesh& mesh, const mesh::MeshIndex& index);

    /// The side of a mesh that a point is on.
    struct Side {
        Eigen::Vector3d normal; ///< of the mesh at the point's foot, unit; zero where the mesh has no direction
        /// How far the point is beyond an open border, measured in the plane of the facets there, mm; 0 if the foot is
        /// not on a border. Above the rounding there, the mesh gives no sign for the point.
        double beyond_border = 0;
    };
    /// @param foot  the closest point   @param offset  from the foot to the point, mm
    Side side(const mesh::MeshIndex::Closest& foot, const Eigen::Vector3d& offset) const;

    /// Unit normal of a facet; zero if it is degenerate.
    Eigen::Vector3d facet_normal(Eigen::Index triangle) const;

  private:
    using Vertex = std::int32_t;
    using Facets = std::vector<std::uint32_t>; ///< ascending
    struct Feature;
    Feature feature_at(const mesh::MeshIndex::Closest& foot) const;
    Eigen::Vector3d normal(const mesh::MeshIndex::Closest& foot, const Feature& on) const;
    double beyond_border(const Feature& on, const Eigen::Vector3d& offset) const;
    void add_edge_normals(const Facets& at_edge, const Eigen::Vector3d& point, double weight, Facets& visited,
                          Eigen::Vector3d& sum) const;
    std::optional<Vertex> vertex_within_edge(const Feature& edge, const Eigen::Vector3d& point) const;
    Eigen::Vector3d vertex_normal(Vertex v, const Facets& at_vertex) const;
    Eigen::Vector3d position(Vertex v) const { return reference_.mesh.vertices.col(v); }
    bool on_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const;
    bool has(std::uint32_t facet, Vertex v) const { return (facets_.col(facet).array() == v).any(); }
    Facets facets_at(Vertex v) const;
    Facets facets_at_edge(Vertex a, Vertex b) const;

    const ReferenceMesh& reference_;
    const mesh::MeshIndex& index_;
    const Eigen::Matrix3Xi& facets_;
};

} // namespace fettle::compare
