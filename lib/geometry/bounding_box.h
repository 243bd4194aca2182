#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle::geometry {

/// Axis-aligned box around points, one per column, at least one, all of them finite.
template <typename Points>
Eigen::AlignedBox<double, Points::RowsAtCompileTime> bounding_box(const Eigen::MatrixBase<Points>& points)
{
    return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
}

/// Box around those of the points that are finite; its corners are NaN if there are none. @param points  3xN
Eigen::AlignedBox3d finite_bounding_box(const Eigen::Matrix3Xd& points);

} // namespace fettle::geometry
