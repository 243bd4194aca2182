#pragma once

#include "surface/band.h"
#include "surface/surface.h"

namespace fettle {

// A spline fitted to many points has thousands of control heights; of their covariance only the inverse is short:
//     H = Σ_cells w · mean of (basis)(basis)ᵀ over the cell  +  K / τ²
// w is the cell's weight: its points count as evenly spread. K is the energy of the third derivatives
// (spline_energy.h), so where there are no points the surface is a random field of Duchon's kind (Wahba 1990, 1.5).

BandMatrix precision_matrix(const Bspline& grid, const SplinePrecision& precision);

/// Standard deviations of the heights; NaN outside. @param xy  2xN
Eigen::VectorXd sigmas(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy);

/// Joint covariance of the heights, NxN. @param xy  2xN, where the spline is defined
Eigen::MatrixXd height_covariance(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy);

} // namespace fettle
