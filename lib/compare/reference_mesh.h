#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle::compare {

/// Repairs made to a mesh before points are compared to it.
struct ReferenceRepair {
    double weld_tolerance = 0; ///< mm: rounding of float coordinates at the median coordinate of the mesh
    Eigen::Index welded_vertices = 0;
    Eigen::Index repeated_facets = 0; ///< dropped: duplicates of an earlier facet with the same winding
    Eigen::Index opposite_facets = 0; ///< dropped: the same corners as an earlier facet, wound the other way
    Eigen::Index flipped_facets = 0;
};

/// Treatment of the facets' windings.
enum class Winding {
    repair, ///< made to agree with the majority of their connected component; closed components face outward
    keep,   ///< left as they are
    flip,   ///< repaired, then all flipped: for an open mesh that is inside out, which cannot be detected
};

/// A mesh prepared for signed distances: vertices that agree within the rounding of floats are welded, so that cracks
/// are not taken for borders; duplicate facets are dropped, also those wound the other way, so that a mesh drawn from
/// both sides has one outer side; windings agree.
struct ReferenceMesh {
    mesh::Mesh mesh;                             ///< with its original vertices
    Eigen::Matrix3Xi welded;                     ///< its triangles with welded vertices; empty: as in `mesh`
    std::vector<std::uint32_t> original_indices; ///< of its triangles, before duplicates were dropped; empty: the same
    double max_weld_distance = 0;                ///< largest distance of a vertex from the one it is welded to, mm
    double coordinate = 0;                       ///< median_coordinate(), mm
    ReferenceRepair repair;
    bool closed = false; ///< no border, and all windings agree

    const Eigen::Matrix3Xi& facets() const { return welded.cols() > 0 ? welded : mesh.triangles; }
    Eigen::Index original_index(Eigen::Index triangle) const
    {
        return original_indices.empty() ? triangle : original_indices[triangle];
    }
    /// Lengths below this at a point are rounding of float coordinates, mm.
    double rounding_at(const Eigen::Vector3d& point) const;
};

/// Repairs a mesh. Only open vertices are welded (OpenVertices); windings are repaired as facets_to_flip() says.
ReferenceMesh reference_mesh(mesh::Mesh mesh, Winding winding = Winding::repair);

} // namespace fettle::compare
