#pragma once

#include "machining/cutter.h"
#include "mesh/box_tree.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace fettle {

/// A cutter that comes down upright onto a mesh until it touches a facet, an edge or a vertex. Thread-safe.
class DropCutter {
  public:
    /// The mesh must outlive it.
    DropCutter(const Mesh& mesh, const Cutter& cutter);

    struct Touch {
        double z = 0;            ///< of the tip, mm
        Eigen::Vector3d contact; ///< where the cutter touches; one of several such places
    };
    /// What happens over xy; nothing if the cutter meets nothing.
    std::optional<Touch> operator()(const Eigen::Vector2d& xy) const;

  private:
    const Mesh& mesh_;
    Cutter cutter_;
    BoxTree tree_;
    /// Which corners (bits 0 to 2) and edges, from a corner on, (bits 3 to 5) are looked at with a triangle: each with
    /// the first that has it.
    std::vector<std::uint8_t> own_;
};

} // namespace fettle
