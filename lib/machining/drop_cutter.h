#pragma once

#include "machining/cutter.h"
#include "mesh/box_tree.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace fettle::machining {

/// Drop-cutter: the height at which a cutter that comes down along Z touches a facet, an edge or a vertex of a mesh.
/// Thread-safe.
class DropCutter {
  public:
    /// The mesh must outlive this object.
    DropCutter(const mesh::Mesh& mesh, const Cutter& cutter);

    struct Touch {
        double z = 0;            ///< height of the tip, mm
        Eigen::Vector3d contact; ///< contact point, mm; if there are several, any of them
    };
    /// The touch of a cutter whose axis is at xy (mm); nothing if it misses the mesh.
    std::optional<Touch> operator()(const Eigen::Vector2d& xy) const;

  private:
    const mesh::Mesh& mesh_;
    Cutter cutter_;
    mesh::BoxTree tree_;
    /// Corners (bits 0 to 2) and edges from these corners on (bits 3 to 5) that are tested with each triangle. Every
    /// vertex and edge belongs to the first triangle that has it.
    std::vector<std::uint8_t> owned_;
};

} // namespace fettle::machining
