#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle::belt {

/// A rectangular grid centred on the origin of the tool frame, with rows of cells along its x and columns along its y.
struct ContactGrid {
    Eigen::Vector2d cell_size = Eigen::Vector2d::Zero(); ///< size of a cell, mm
    Eigen::Index rows = 0, columns = 0;

    Eigen::Vector2d half_size() const { return {cell_size.x() * rows / 2, cell_size.y() * columns / 2}; }
    /// Centre of a cell, mm.
    Eigen::Vector2d cell_center(Eigen::Index row, Eigen::Index column) const
    {
        return {static_cast<double>(2 * row + 1 - rows) / 2 * cell_size.x(),
                static_cast<double>(2 * column + 1 - columns) / 2 * cell_size.y()};
    }
};

/// Surfels are used up to this multiple of the grid's half size, so that border cells have neighbours on all sides.
inline constexpr double kGridMargin = 1.2;

/// Selects the surfels that face the tool, lie within the grid's margin, and at most `max_depth` (mm) below the tangent
/// plane through the contact point. @return  their coordinates in the tool frame, 3xN, mm
/// @param indices  of candidates; keeps those selected
Eigen::Matrix3Xd select_facing_surfels(const Surfels& surfels, std::vector<Eigen::Index>& indices,
                                       const Eigen::Isometry3d& T_part_tool, const ContactGrid& grid, double max_depth);

/// Mean distance between neighbours of evenly spread points, projected along z, mm.
double mean_spacing(const Eigen::Matrix3Xd& points);

/// Averages of a field over axis-parallel squares, from summed-area tables (Crow 1984). The cells' values are means; in
/// each cell the field is linear, with monotonized central slopes (van Leer 1977), so that averages over squares of any
/// size are of second order and none is negative. The field is 0 outside the grid. Squares that tile the plane preserve
/// the integral of the field.
class BoxAverage {
  public:
    /// @param field  per cell, ≥ 0
    BoxAverage(const ContactGrid& grid, const Eigen::MatrixXd& field);
    /// @param center  of the square, tool frame, mm   @param side  mm
    double mean_around(const Eigen::Vector2d& center, double side) const;

  private:
    /// A coordinate along one axis: its cell, and the fraction of the cell below it.
    struct CellCoordinate {
        Eigen::Index cell;
        double fraction;
        double parabola() const { return fraction * (fraction - 1) / 2; } ///< integral of a slope of 1 about the middle
    };
    double integral_to(const CellCoordinate& x, const CellCoordinate& y) const;

    ContactGrid grid_;
    Eigen::Array2d cells_per_mm_, half_grid_; ///< the latter in cells
    Eigen::MatrixXd sums_;                    ///< summed-area table at the corners of the cells
    Eigen::MatrixXd x_slopes_, y_slopes_;     ///< per cell, summed along y and along x: at the cells' lower corners
};

} // namespace fettle::belt
