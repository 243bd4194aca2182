#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::cloud {

/// Profiles of a laser profiler: consecutive points of a cloud, each profile measured in the same direction.
struct Profiles {
    std::vector<Eigen::Index> first; ///< first point of each profile, and the number of points at the end
    Eigen::Vector3d direction;       ///< unit: along the profiles, in the order of their points
};

/// Finds the profiles of points in the order in which they were measured: along the direction of most steps the points
/// advance, and only between two profiles they go back, by more than ten steps. Rows of a raster that run one way are
/// profiles, too; rows of cubes of a grid, in which filters leave their points, are none.
/// @param xyz  3xN, finite, in the order of the file
/// @return  nothing for points in another order: fewer than three profiles, or of less than five points on average
std::optional<Profiles> find_profiles(const Eigen::Matrix3Xd& xyz);

} // namespace fettle::cloud
