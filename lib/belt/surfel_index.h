#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace fettle::belt {

/// Hash grid of the surfels' positions on the design surface. It stays beside geometry::PointIndex because the search
/// box is long, flat and tilted: the cells that meet it are taken whole, in an order that decides ties in gridding.
class SurfelIndex {
  public:
    /// @param side  of a cell, mm; best about the size of the queries
    SurfelIndex(const Surfels& surfels, double side);

    /// Replaces `result` by all surfels in the cells that meet a box in the given frame, in the order of the cells;
    /// some are outside the box.
    void box_search(const Eigen::Isometry3d& T_part_frame, const Eigen::AlignedBox3d& box,
                    std::vector<Eigen::Index>& result) const;

  private:
    using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
    Cell cell_of(const Eigen::Vector3d& p) const { return (p / side_).array().floor().cast<std::int64_t>(); }
    static std::uint64_t column_key(const Cell& cell);

    /// The cells that lie over each other are looked up at once: few of a box's cells have surfels.
    struct FilledCell {
        std::int64_t z;
        std::size_t begin, end; ///< in order_
    };
    double side_;
    std::vector<Eigen::Index> order_;                                                ///< surfels sorted by cell
    std::vector<FilledCell> cells_;                                                  ///< by column, ascending in z
    std::unordered_map<std::uint64_t, std::pair<std::size_t, std::size_t>> columns_; ///< by key, in cells_
};

} // namespace fettle::belt
