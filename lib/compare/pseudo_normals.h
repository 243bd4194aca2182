#pragma once

#include "compare/reference_mesh.h"
#include "mesh/mesh_index.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fettle::compare {

/// Normals that give a point the right sign wherever its closest point on a mesh lies: the normal of the facet, the sum
/// of the two facets' on an edge, the angle-weighted sum on a vertex (Bærentzen & Aanæs, Signed distance computation
/// using the angle weighted pseudonormal, 2005). Facets narrower than the rounding of floats (needles) have no normal;
/// the search continues in their neighbours. Thread-safe.
class PseudoNormals {
  public:
    /// The mesh must outlive this.
    explicit PseudoNormals(const ReferenceMesh& mesh);

    /// Unit normal at a closest point; zero where the mesh has no direction.
    Eigen::Vector3d normal(const mesh::MeshIndex::Closest& foot) const;

    /// Unit normal of a facet; zero if it is degenerate.
    Eigen::Vector3d facet_normal(Eigen::Index triangle) const;

    /// How far `offset` (from the foot to the point) leads beyond an open border, measured in the plane of the facets
    /// there, mm; 0 if the foot is not on a border. Above the rounding there, the mesh gives no sign for the point.
    double beyond_border(const mesh::MeshIndex::Closest& foot, const Eigen::Vector3d& offset) const;

  private:
    using Vertex = std::int32_t;
    struct Feature;
    Feature feature_at(const mesh::MeshIndex::Closest& foot) const;
    std::vector<Eigen::Index> facets_at_edge(Vertex a, Vertex b) const;
    void add_edge_normals(Vertex a, Vertex b, const Eigen::Vector3d& point, double weight,
                          std::vector<Eigen::Index>& visited, Eigen::Vector3d& sum) const;
    std::optional<Vertex> vertex_within_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const;
    Eigen::Vector3d vertex_normal(Vertex v) const;
    Eigen::Vector3d position(Vertex v) const { return reference_.mesh.vertices.col(v); }
    bool on_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const;
    /// Facets at a vertex, ascending.
    std::span<const std::uint32_t> facets_at(Vertex v) const;

    const ReferenceMesh& reference_;
    const Eigen::Matrix3Xi& facets_;
    std::vector<std::uint32_t> first_;         ///< vertex -> its first entry in vertex_facets_
    std::vector<std::uint32_t> vertex_facets_; ///< facets at the vertices, vertex by vertex
};

} // namespace fettle::compare
