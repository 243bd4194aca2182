#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle {

/// What was mended of a mesh before points are compared to it.
struct ReferenceRepair {
    double weld_tolerance = 0; ///< at the middle of the mesh, mm: the rounding of float coordinates there
    Eigen::Index welded_vertices = 0;
    Eigen::Index repeated_facets = 0; ///< left out: they stand once
    Eigen::Index flipped_facets = 0;
};

/// Which way round facets are taken.
enum class Winding {
    mend, ///< as most of their connected piece; closed pieces with their outer side out
    keep, ///< as they are
    turn, ///< mended, then all turned over: for an open mesh that is inside out, of which nobody else can know
};

/// A mesh as it is compared to: vertices that agree within the rounding of floats count as one, so that cracks are no
/// borders; what stands twice stands once; windings agree.
struct ReferenceMesh {
    Mesh mesh;                       ///< exactly where it was
    Eigen::Matrix3Xi welded;         ///< its triangles with welded vertices; none: as in `mesh`
    std::vector<std::uint32_t> from; ///< of its triangles, numbers in the original; none: the same
    double size = 0;                 ///< how far from the origin it lies: the median of its vertices, mm
    ReferenceRepair repair;

    const Eigen::Matrix3Xi& facets() const { return welded.cols() > 0 ? welded : mesh.triangles; }
    Eigen::Index original(Eigen::Index triangle) const
    {
        return from.empty() ? triangle : from[static_cast<std::size_t>(triangle)];
    }
    /// Lengths below this, at a place, are the rounding of float coordinates, mm.
    double rounding(const Eigen::Vector3d& place) const;
};

/// Only vertices whose facets leave a gap are welded. Of facets that share an edge the way round that most of their
/// connected area has is taken for right; a closed piece that is inside out and not in another one's box, where it
/// might be a cavity, is turned.
ReferenceMesh reference_mesh(Mesh mesh, Winding winding = Winding::mend);

} // namespace fettle
