#pragma once

#include "compare/reference_mesh.h"
#include "core/large_array.h"
#include "mesh/mesh_index.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fettle {

/// Normals that give a point the right side of a mesh wherever its closest point lies: of the facet, the sum of two
/// facets on an edge, weighted by angle on a vertex (Bærentzen & Aanæs, Signed distance computation using the angle
/// weighted pseudonormal, 2005). Facets narrower than the rounding of floats have no direction of their own and are
/// looked through. Thread-safe.
class PseudoNormals {
  public:
    /// The mesh must outlive this.
    explicit PseudoNormals(const ReferenceMesh& mesh);

    /// Unit normal at a closest point; zero where the mesh has no direction.
    Eigen::Vector3d normal(const MeshIndex::Closest& foot) const;

    /// Unit normal of a facet; zero if it has none.
    Eigen::Vector3d facet(Eigen::Index triangle) const;

    /// How far `offset` (from the foot to the point) leads beyond an open border, measured in the plane of the facets
    /// there, mm; 0 if the foot lies on no border. More than the rounding there: the mesh says nothing about the point.
    double beyond_border(const MeshIndex::Closest& foot, const Eigen::Vector3d& offset) const;

  private:
    using Vertex = std::int32_t;
    struct Feature;
    Feature feature(const MeshIndex::Closest& foot) const;
    std::vector<Eigen::Index> facets_at_edge(Vertex a, Vertex b) const;
    void add_beyond_edge(Vertex a, Vertex b, const Eigen::Vector3d& point, double weight,
                         std::vector<Eigen::Index>& seen, Eigen::Vector3d& sum) const;
    std::optional<Vertex> vertex_amid(Vertex a, Vertex b, const Eigen::Vector3d& point) const;
    Eigen::Vector3d vertex_normal(Vertex v) const;
    Eigen::Vector3d position(Vertex v) const { return reference_.mesh.vertices.col(v); }
    double rounding(const Eigen::Vector3d& place) const { return reference_.rounding(place); }
    bool on_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const;
    /// Facets at a vertex, ascending.
    std::span<const std::uint32_t> facets_at(Vertex v) const;

    const ReferenceMesh& reference_;
    const Eigen::Matrix3Xi& facets_;
    LargeArray<std::uint32_t> first_;     ///< vertex -> its first entry in at_vertex_
    LargeArray<std::uint32_t> at_vertex_; ///< facets at the vertices
};

} // namespace fettle
