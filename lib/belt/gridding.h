#pragma once

#include "belt/contact_grid.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Interpolation of heights from the nearest surfels: weights by the inverse squared distance (Shepard 1968), or
/// ordinary kriging with the variogram γ(d) = d, which also takes the arrangement of the surfels into account (Cressie
/// 1993, 3.2).
enum class Gridding { shepard, kriging };

/// Workpiece under the cells of a grid.
struct GriddedHeights {
    Eigen::MatrixXd height;   ///< at the centres of the cells, mm; NaN: no workpiece in the cell
    Eigen::MatrixXd coverage; ///< share of the cell's area over the workpiece
};

/// A point stands for a square of one mean spacing, and gaps of up to two spacings between points are bridged.
///
/// What a wheel removes ends with a kink at the border of its contact, somewhere between the last point that it touched
/// and the next one, and interpolation would round it off over a spacing. Between such points the height before and the
/// depth removed are interpolated apart: the former as ever, the latter as a plane through those that were touched, to
/// where it is zero (subcell resolution, after Harten 1989).
/// @param points  3xN: x, y, height, mm
/// @param removed  depth that the points lost, mm; empty: unknown
GriddedHeights interpolate_heights(const ContactGrid& grid, const Eigen::Matrix3Xd& points, Gridding gridding,
                                   const Eigen::VectorXd& removed = {});

} // namespace fettle::belt
