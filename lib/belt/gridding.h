#pragma once

#include "belt/contact_grid.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Interpolation of heights from the nearest surfels: weights by the inverse squared distance (Shepard 1968), or
/// ordinary kriging with the variogram γ(d) = d, which also takes the arrangement of the surfels into account (Cressie
/// 1993, 3.2).
enum class Gridding { shepard, kriging };

/// Heights at the centres of the cells, mm; NaN where the nearest point is farther than twice the mean spacing.
/// @param points  3xN: x, y, height, mm
Eigen::MatrixXd interpolate_heights(const ContactGrid& grid, const Eigen::Matrix3Xd& points, Gridding gridding);

} // namespace fettle::belt
