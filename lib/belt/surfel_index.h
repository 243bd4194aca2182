#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace fettle {

/// Surfels by where they are on the design surface, in cubes.
class SurfelIndex {
  public:
    /// @param side  of the cubes, mm: about the size of what will be asked for
    SurfelIndex(const Surfels& surfels, double side);

    /// All surfels in a box that is given in a frame, and others near, in the order of the cubes.
    void in_box(const Eigen::Isometry3d& T_part_frame, const Eigen::AlignedBox3d& box,
                std::vector<Eigen::Index>& result) const;

  private:
    using Cube = Eigen::Matrix<std::int64_t, 3, 1>;
    Cube cube_of(const Eigen::Vector3d& place) const { return (place / side_).array().floor().cast<std::int64_t>(); }
    static std::uint64_t key(const Cube& cube);

    double side_;
    std::vector<Eigen::Index> order_;
    std::unordered_map<std::uint64_t, std::pair<std::size_t, std::size_t>> range_; ///< of order_
};

} // namespace fettle
