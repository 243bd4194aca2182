#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle {

/// A rectangle of cells about the origin of the tool frame, along its x (rows) and y (columns).
struct ContactCells {
    Eigen::Vector2d cell = Eigen::Vector2d::Zero(); ///< sides, mm
    Eigen::Index rows = 0, columns = 0;

    Eigen::Vector2d half() const
    {
        return cell.cwiseProduct(Eigen::Vector2d(static_cast<double>(rows), static_cast<double>(columns))) / 2;
    }
    Eigen::Vector2d middle(Eigen::Index row, Eigen::Index column) const
    {
        return {(static_cast<double>(2 * row + 1 - rows) / 2) * cell.x(),
                (static_cast<double>(2 * column + 1 - columns) / 2) * cell.y()};
    }
};

/// How far the surfels looked at go, over the cells: neighbours for the cells at the border.
inline constexpr double kBeside = 1.2;

/// Where surfels are in the tool frame: x, y, and their height over the plane through the contact point, mm. Only those
/// that face the tool, are over the cells or near, and not deeper than `deepest` below the plane.
/// @param which  surfels to look at; those that are not among them go
Eigen::Matrix3Xd facing(const Surfels& surfels, std::vector<Eigen::Index>& which, const Eigen::Isometry3d& T_part_tool,
                        const ContactCells& cells, double deepest);

/// The least box around points, as seen along z.
Eigen::AlignedBox2d box_over(const Eigen::Matrix3Xd& points);

/// The mean distance between neighbours of points that are spread evenly, mm.
double spacing_of(const Eigen::Matrix3Xd& points);

/// Means of a field over squares, the field the same all over a cell and 0 beyond them all: squares that share out the
/// plane share out the field's integral, however small the cells are.
class SquareMeans {
  public:
    /// @param side  of the squares, mm; along the tool frame's axes
    SquareMeans(const ContactCells& cells, const Eigen::MatrixXd& field, double side);
    double about(const Eigen::Vector2d& place) const;

  private:
    /// A place along one axis: in which cell, and the part of it that is before the place.
    struct Along {
        Eigen::Index cell;
        double part;
    };
    double until(const Along& x, const Along& y) const;

    ContactCells cells_;
    Eigen::Array2d cells_each_, middle_, half_; ///< cells a mm; half of the grid and of a square, in cells
    Eigen::MatrixXd sums_;                      ///< of all cells before each corner
};

} // namespace fettle
