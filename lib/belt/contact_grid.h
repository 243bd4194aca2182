#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle {

/// A rectangle of cells about the origin of the tool frame, along its x (rows) and y (columns).
struct ContactCells {
    Eigen::Vector2d cell; ///< sides, mm
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

/// How heights between surfels are estimated from the nearest ones: weights by the inverse square of the distance
/// (Shepard 1968), or ordinary kriging with the variogram γ(d) = d, which also sees how they lie about the place
/// (Cressie 1993, 3.2).
enum class Gridding { shepard, kriging };

/// How far the surfels looked at go, over the cells: neighbours for the cells at the border.
constexpr double kBeside = 1.2;

/// Where surfels are in the tool frame: x, y, and their height over the plane through the contact point, mm. Only those
/// that face the tool, are over the cells or near, and not deeper than `deepest` below the plane.
/// @param which  surfels to look at; those that are not among them go
Eigen::Matrix3Xd facing(const Surfels& surfels, std::vector<Eigen::Index>& which, const Eigen::Isometry3d& T_part_tool,
                        const ContactCells& cells, double deepest);

/// Heights at the middles of the cells, mm; NaN where no point is near: nearer than twice the mean distance between
/// neighbours.
/// @param points  x, y, height
Eigen::MatrixXd heights_on(const ContactCells& cells, const Eigen::Matrix3Xd& points, Gridding gridding);

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
    double until(double x, double y) const;

    ContactCells cells_;
    double side_;
    Eigen::MatrixXd sums_; ///< of all cells before each corner
};

} // namespace fettle
