#pragma once

#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "machining/workpiece.h"
#include "removal/height_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fettle::machining {

inline constexpr double kRefinedSlopeDegrees = 60;

/// Heights of a machined surface on a finer grid where it is steep. The grid is refined on squares between the centres
/// of four cells: a square is refined if its corners differ in height by more than a slope of kRefinedSlopeDegrees has
/// over one cell.
class Refinement {
  public:
    /// @param piece    before the cut
    /// @param machined the result of mill(); it must outlive this object
    /// @param factor   number of grid points along the side of a square, a power of two
    Refinement(const Workpiece& piece, const removal::HeightField& machined, const Cutter& cutter,
               const std::vector<CutterMove>& moves, int factor);

    int factor() const { return factor_; }
    /// Whether the square between cells i, i + 1 and j, j + 1 is refined; false outside the grid.
    bool is_refined(Eigen::Index i, Eigen::Index j) const;
    std::size_t count() const; ///< number of refined squares
    /// Point (a, b) of the fine grid in a refined square, mm: a / factor of the distance from cell i to i + 1 and b /
    /// factor from j to j + 1. z is NaN where there is no material.
    Eigen::Vector3d point(Eigen::Index i, Eigen::Index j, int a, int b) const;

  private:
    const removal::HeightField& machined_;
    int factor_;
    Eigen::Index columns_, rows_, tile_columns_; ///< numbers of squares, and of tiles in a row
    std::vector<std::uint8_t> refined_;          ///< whether each square is refined, row by row
    std::vector<std::int32_t> tile_;             ///< index of each tile's field, -1: none
    std::vector<removal::HeightField> fields_;   ///< fine grids of the tiles that contain refined squares
};

} // namespace fettle::machining
