#pragma once

#include <Eigen/Core>

#include <optional>

namespace fettle::geometry {

/// Median of the finite points by coordinate, of a sample of them: points far off do not move it, unlike a mean or the
/// middle of their box. @param points  3xN   @return  zero if none of the sample is finite
Eigen::Vector3d sampled_median(const Eigen::Matrix3Xd& points);

/// A point so far from all others that it can hardly belong to them, as a damaged file has it.
struct StrayPoint {
    Eigen::Index index = 0;
    double ratio = 0; ///< its distance from the middle over that of half of the points; both of the median
};

/// The farthest of the finite points, if its ratio is over 1000. No part is so slender that one of its own has such a
/// ratio while scans have points all over it. @param points  3xN
std::optional<StrayPoint> find_stray_point(const Eigen::Matrix3Xd& points);

} // namespace fettle::geometry
