#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle {

/// The upper surface of a point cloud, where it has one: around a vertical line a quadratic through the points near it.
class PointSurface {
  public:
    /// @param points  3xN, mm; columns with NaN are left out
    explicit PointSurface(const Eigen::Matrix3Xd& points);

    /// z of the surface over xy: robust local quadratic of the points within 3 spacings of the vertical line. Of
    /// several sheets (the upper and the lower side of a plate) the highest. Nothing where fewer points than a
    /// quadratic needs are near, or where they do not surround the line (a hole, the border).
    std::optional<double> height(const Eigen::Vector2d& xy) const;
    /// z of the highest point within `radius` of the vertical line.
    std::optional<double> highest(const Eigen::Vector2d& xy, double radius) const;
    /// z of the lowest point of a ball that comes down over xy, when it first touches the surface.
    std::optional<double> drop_ball(const Eigen::Vector2d& xy, double radius) const;

    /// Side of the square that one point has on average (median over the cloud), mm.
    double spacing() const { return spacing_; }

  private:
    std::vector<Eigen::Vector3d> near(const Eigen::Vector2d& xy, double radius) const;
    double density_spacing() const;

    Eigen::Matrix3Xd points_; ///< sorted by cell
    Eigen::Vector2d origin_;
    double cell_ = 1;
    Eigen::Vector2i size_;
    std::vector<Eigen::Index> start_; ///< points of cell c: start_[c] up to start_[c + 1]
    double spacing_ = 0;
};

} // namespace fettle
