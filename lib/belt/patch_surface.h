#pragma once

#include "belt/local_fit.h"
#include "core/error.h"
#include "geometry/point_index.h"

#include <Eigen/Geometry>

#include <array>
#include <optional>

namespace fettle::belt {

/// A patch has no or too few surfels for a surface.
struct PatchTooSmall : core::InputError {
    using core::InputError::InputError;
};

/// One patch of surfels as a surface over two lengths, along u and v from their minima, mm. The lengths are measured by
/// the maximum speeds of the parameters, so that no iso-curve is longer than its difference in length.
class PatchSurface {
  public:
    /// @param on_stock  the surface is the stock's, where it is known, otherwise the design's
    /// @throws PatchTooSmall if there is no such patch, or too few surfels on it
    PatchSurface(const Surfels& surfels, int patch, bool on_stock);

    /// Width of the patch along u (axis 0) or v (axis 1), mm: an upper bound of the iso-curves' lengths.
    double width(int axis) const { return lengths_[axis][lengths_[axis].size() - 1]; }
    /// Local fit, or nothing outside the patch.
    std::optional<LocalFit> fit_at(const Eigen::Vector2d& lengths) const;

  private:
    double parameter(int axis, double length) const;
    double length(int axis, double parameter) const;
    Eigen::Matrix2Xd max_speeds() const;
    void measure_lengths();

    int patch_;
    Surfels surfels_;
    double max_radius_ = 0;
    Eigen::AlignedBox2d uv_box_;
    std::array<Eigen::VectorXd, 2> lengths_;            ///< along u and v at the ends of their intervals, mm
    std::optional<geometry::PointIndex<2>> neighbours_; ///< in the plane of the lengths
};

} // namespace fettle::belt
