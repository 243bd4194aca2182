#pragma once

#include "robot/clearance.h"
#include "robot/height_grid.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fettle::robot {

/// The cuboids of a height grid for distance queries of bodies, as solid boxes: on each occupied cell from z = 0 to
/// its height. A pyramid of the largest heights of 2 x 2, 4 x 4 … cells bounds the distances of many at a time.
class CuboidSearch {
  public:
    /// The grid must outlive it.
    explicit CuboidSearch(const HeightGrid& grid);

    /// The clearance of the nearest cuboid that is not left out, in the grid's frame; nothing if none is nearer than
    /// `max_distance`, mm.
    /// @param body  in the grid's frame
    /// @param left_out  by cell: 1 if its cuboid does not count
    /// @param areas  rectangles whose cells are all left out: blocks of cells inside one are not looked at
    std::optional<Clearance> nearest(const PlacedSolid& body, double max_distance, std::span<const char> left_out,
                                     std::span<const Footprint> areas) const;

  private:
    /// 2^level x 2^level cells.
    struct Block {
        std::int32_t level, column, row;
    };
    struct Level {
        Eigen::Index columns, rows;
        std::vector<double> heights; ///< the largest; negative: no cell is occupied
    };
    Eigen::AlignedBox3d box_of(const Block& block) const;
    double height_of(const Block& block) const;

    const HeightGrid& grid_;
    std::vector<Level> levels_; ///< levels 1, 2 …; the last is one block
};

} // namespace fettle::robot
