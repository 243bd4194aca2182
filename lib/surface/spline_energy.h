#pragma once

#include "surface/band.h"
#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle::surface {

// Quadratic forms of a spline's control heights (column-major, u runs fastest). The heights of `grid` are not read.

/// Zero matrix with a band wide enough for products of overlapping basis functions.
BandMatrix zero_band_matrix(const Bspline& grid);

/// Adds factor · K, where cᵀ K c = E(f) = ∫∫ f_uuu² + 3 f_uuv² + 3 f_uvv² + f_vvv² du dv over the rectangle is
/// the rotation-invariant energy of the third derivatives (Duchon 1977). The integration is exact.
void add_derivative_energy(BandMatrix& sum, const Bspline& grid, double factor);

/// Adds Σ_cells weight · mean of (basis)(basis)ᵀ over the cell: data points evenly distributed over the cell.
/// @param weights  cells_u x cells_v
void add_cell_weights(BandMatrix& sum, const Bspline& grid, const Eigen::MatrixXd& weights);

/// Control heights of 1, u, v, u², uv, v² by Marsden's identity; u, v from the rectangle's middle in units of `half`.
struct QuadraticControlHeights {
    Eigen::MatrixXd heights; ///< N x 6
    Eigen::Vector2d middle;  ///< middle of the rectangle in its own axes, from its corner, mm
    double half_side = 1;    ///< half the longer side, mm
};
QuadraticControlHeights quadratic_control_heights(const Bspline& grid);

} // namespace fettle::surface
