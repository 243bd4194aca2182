#pragma once

#include "belt/contact_grid.h"

#include <Eigen/Core>

namespace fettle {

/// How heights between surfels are estimated from the nearest ones: weights by the inverse square of the distance
/// (Shepard 1968), or ordinary kriging with the variogram γ(d) = d, which also sees how they lie about the place
/// (Cressie 1993, 3.2).
enum class Gridding { shepard, kriging };

/// Heights at the middles of the cells, mm; NaN where no point is near: nearer than twice the mean distance between
/// neighbours.
/// @param points  x, y, height
Eigen::MatrixXd heights_on(const ContactCells& cells, const Eigen::Matrix3Xd& points, Gridding gridding);

} // namespace fettle
