#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::sampling {

/// The triangles of a mesh in the square cells of a grid in the x-y plane, for exact contacts of a point or a ball that
/// is lowered vertically; a ray tracer has no contact of a ball.
class TriangleGrid {
  public:
    /// The mesh must outlive the grid.
    explicit TriangleGrid(const mesh::Mesh& mesh);
    explicit TriangleGrid(mesh::Mesh&&) = delete;

    /// Highest z of the mesh over xy.
    std::optional<double> highest(const Eigen::Vector2d& xy) const;
    /// z of the centre of a ball that is lowered over xy until it first touches a facet, an edge or a vertex.
    std::optional<double> ball_centre(const Eigen::Vector2d& xy, double radius) const;

    /// Calls visit(triangle) for the triangles of the cells that overlap a box, for some of them several times.
    template <typename Visit>
    void visit(const Eigen::Vector2d& low, const Eigen::Vector2d& high, Visit&& visit) const
    {
        const Eigen::Vector2i from = cell_of(low), to = cell_of(high);
        for (int y = from.y(); y <= to.y(); ++y)
            for (int x = from.x(); x <= to.x(); ++x) {
                const std::size_t c = static_cast<std::size_t>(y) * size_.x() + x;
                for (std::size_t e = start_[c]; e < start_[c + 1]; ++e) visit(entries_[e]);
            }
    }

  private:
    Eigen::Vector2i cell_of(const Eigen::Vector2d& xy) const;

    const mesh::Mesh& mesh_;
    Eigen::Vector2d origin_;
    double cell_ = 1;      ///< side, mm
    Eigen::Vector2i size_; ///< cells in x and y
    // The triangles of cell c are entries_[start_[c]] up to entries_[start_[c + 1]].
    std::vector<std::size_t> start_;
    std::vector<int> entries_;
};

} // namespace fettle::sampling
