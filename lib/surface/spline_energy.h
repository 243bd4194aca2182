#pragma once

#include "surface/band.h"
#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle {

// Quadratic forms of a spline's control heights (column-major, those of u run fastest). The heights of `grid` are not
// read.

/// All zero, wide enough for products of basis functions that overlap.
BandMatrix band_over(const Bspline& grid);

/// Adds factor · K, cᵀ K c = E(f) = ∫∫ f_uuu² + 3 f_uuv² + 3 f_uvv² + f_vvv² du dv over the rectangle: the
/// rotation-invariant energy of the third derivatives (Duchon 1977). Exact.
void add_energy(BandMatrix& sum, const Bspline& grid, double factor);

/// Adds Σ_cells weight · mean of (basis)(basis)ᵀ over the cell: that many points, evenly spread.
/// @param weights  cells_u x cells_v
void add_uniform(BandMatrix& sum, const Bspline& grid, const Eigen::MatrixXd& weights);

/// Control heights of 1, u, v, u², uv, v²; u, v from the rectangle's middle in units of `half` (Marsden's identity).
struct Quadratics {
    Eigen::MatrixXd heights; ///< N x 6
    Eigen::Vector2d middle;  ///< of the rectangle, in its own axes, from its corner, mm
    double half = 1;         ///< half the longer side, mm
};
Quadratics quadratics(const Bspline& grid);

} // namespace fettle
