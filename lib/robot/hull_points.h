#pragma once

#include <Eigen/Core>

namespace fettle::robot {

/// The points that span the convex hull of some points: the others, inside it, on its faces or drawn twice, never are
/// the farthest along a direction, and each costs as much in every step of a distance query. A body of more than some
/// thousand points on its hull keeps all that it has.
/// @param points  3xN
/// @return  a subset in the same order; its hull contains every point to 1e-9 of their extent
Eigen::Matrix3Xd hull_points(const Eigen::Matrix3Xd& points);

} // namespace fettle::robot
