#pragma once

#include "surface/band.h"
#include "surface/surface.h"

namespace fettle::surface {

// A spline fitted to many points has thousands of control heights. Their covariance is dense, its inverse is banded:
//     H = Σ_cells w · mean of (basis)(basis)ᵀ over the cell  +  K / τ²
// w is the weight of a cell, whose points are treated as evenly distributed. K is the energy of the third derivatives
// (spline_energy.h): where there are no points, the surface is a random field with Duchon's seminorm (Wahba 1990, 1.5).

/// The matrix H above.
BandMatrix precision_matrix(const Bspline& grid, const SplinePrecision& precision);

/// Standard deviations of the heights, mm; NaN outside the spline's rectangle. @param xy  2xN, M, mm
Eigen::VectorXd sigmas(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy);

/// Joint covariance of the heights, NxN, mm². @param xy  2xN, M, mm, inside the spline's rectangle
Eigen::MatrixXd height_covariance(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy);

} // namespace fettle::surface
