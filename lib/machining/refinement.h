#pragma once

#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "machining/workpiece.h"
#include "removal/height_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fettle {

inline constexpr double kSteepSquare = 60; // degrees

/// Where a machined surface is steep, its heights at more places: on the squares between the centres of four cells. A
/// square is steep if two of its corners differ in height by more than the way between two cells at kSteepSquare.
class Refinement {
  public:
    /// @param piece    as it was before the cut, which knows its heights everywhere
    /// @param machined what mill() made of it
    /// @param factor   so many places along a cell's side, a power of two
    Refinement(const Workpiece& piece, const HeightField& machined, const Cutter& cutter,
               const std::vector<CutterMove>& moves, int factor);

    int factor() const { return factor_; }
    /// Is the square between cells i, i + 1 and j, j + 1 refined? Squares beyond the map are not.
    bool refined(Eigen::Index i, Eigen::Index j) const;
    std::size_t count() const; ///< of refined squares
    /// A place of a refined square, mm: share a / factor of the way from cell i to i + 1, b / factor from j to j + 1; z
    /// NaN: no material.
    Eigen::Vector3d place(Eigen::Index i, Eigen::Index j, int a, int b) const;

  private:
    const HeightField& machined_;
    int factor_;
    Eigen::Index columns_, rows_, tiles_across_; ///< of squares; of tiles
    std::vector<std::uint8_t> refined_;          ///< of squares, row by row
    std::vector<std::int32_t> tile_;             ///< of each tile: its field, -1: it has none
    std::vector<HeightField> fields_;
};

} // namespace fettle
