#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace fettle::machining {

/// The vertical facets of a mesh, as line segments in plan view in a uniform grid. Thread-safe.
class Walls {
  public:
    /// @param cell  about the size of the query triangles, mm
    Walls(const mesh::Mesh& mesh, double cell);

    /// Whether a wall runs through a triangle in plan view (2x3, mm) or along its border.
    bool intersects(const Eigen::Matrix<double, 2, 3>& triangle) const;

  private:
    template <typename Visit>
    void for_bins(const Eigen::Array2d& min, const Eigen::Array2d& max, const Visit& visit) const;

    std::vector<std::array<Eigen::Vector2d, 2>> segments_;
    Eigen::Array2d origin_{0, 0};
    double bin_size_ = 1; ///< mm
    Eigen::Index columns_ = 0, rows_ = 0;
    std::vector<std::vector<std::size_t>> bins_; ///< indices of the segments whose bounding boxes overlap each bin
};

} // namespace fettle::machining
