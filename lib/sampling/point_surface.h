#pragma once

#include "geometry/planar_grid.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::sampling {

/// Upper surface of a point cloud: over each point of the x-y plane a local quadratic is fitted to the nearby points.
class PointSurface {
  public:
    /// @param points  3xN, mm; columns with NaN are ignored
    explicit PointSurface(const Eigen::Matrix3Xd& points);

    /// z of the surface over xy: robust local quadratic of the points within 3 spacings of the vertical line. Of
    /// several sheets (the upper and the lower side of a plate) the highest is used. Nothing if there are too few
    /// points for a quadratic or if they do not surround the line (at a hole or the border).
    std::optional<double> height(const Eigen::Vector2d& xy) const;
    /// z of the highest point within `radius` of the vertical line.
    std::optional<double> highest(const Eigen::Vector2d& xy, double radius) const;
    /// z of the lowest point of a ball that is lowered over xy until it first touches the surface.
    std::optional<double> drop_ball(const Eigen::Vector2d& xy, double radius) const;
    /// Point spacing, mm: the side of the square that a point has on average, median over the cloud.
    double spacing() const { return spacing_; }

  private:
    std::vector<Eigen::Vector3d> points_within(const Eigen::Vector2d& xy, double radius) const;
    double median_spacing() const;

    Eigen::Matrix3Xd points_; ///< sorted by cell
    geometry::PlanarGrid grid_;
    double spacing_ = 0;
};

} // namespace fettle::sampling
