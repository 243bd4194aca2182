#pragma once

#include "machining/cutter.h"
#include "mesh/mesh.h"
#include "sampling/triangle_grid.h"

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

    /// z of the tip over xy; nothing if the cutter meets nothing.
    std::optional<double> operator()(const Eigen::Vector2d& xy) const;

  private:
    template <typename Side>
    double drop(const Eigen::Vector2d& xy) const;

    const Mesh& mesh_;
    Cutter cutter_;
    TriangleGrid grid_;
    /// A triangle seen from above, and its highest z.
    struct Box {
        Eigen::Array2d low, high;
        double top;
    };
    std::vector<Box> boxes_;
    /// Which corners (bits 0 to 2) and edges, from a corner on, (bits 3 to 5) are looked at with a triangle: each with
    /// the first that has it.
    std::vector<std::uint8_t> own_;
};

} // namespace fettle
