#pragma once

#include <Eigen/Core>

namespace fettle::geometry {

/// The points that divide a segment into equal pieces no longer than `max_length`, in order, without its two ends.
/// @return  2xN, in the unit of the ends; none if the segment is one such piece
/// @throws InputError if max_length is not positive
Eigen::Matrix2Xd division_points(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double max_length);

} // namespace fettle::geometry
