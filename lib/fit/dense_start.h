#pragma once

#include "fit/dense_points.h"
#include "fit/smoothing.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::fit {

/// Initial estimate for fit_dense(), whose redescending weights need one near the majority of the points in each
/// neighbourhood.
struct DenseStart {
    Eigen::Matrix<double, 6, 1> trend; ///< the quadratic of least squares (spline_energy.h, Quadratics)
    surface::Bspline spline;           ///< on the grid; without the trend
    double sigma = 0;                  ///< standard deviation of a point, from the median residual, mm
    double lambda = 0;                 ///< of `spline` (smoothing.h)
    PointCounts counts;
};

/// Least absolute deviations of a few points of each cell by weights 1/|r|, on ever finer grids. The points are sampled
/// by a hash of their index (Waterman's reservoir), so that dense patches do not outweigh the rest. The problem is
/// convex, so a detail that the majority of its points agree on is found even if the coarser grids missed it.
/// @throws InputError if the points do not determine a quadratic
DenseStart estimate_dense_start(const DensePoints& points, const std::string& name);

/// Factors for the cells' weights that keep dense patches from outweighing their surroundings: the product is at most
/// kMaxDensityRatio times the median of the cells that have points.
Eigen::MatrixXd density_factors(const Eigen::MatrixXd& weights);
inline constexpr double kMaxDensityRatio = 4;

/// Bound of the residuals' variance due to single-precision coordinates, which are wrong by up to 2^-25 of their size.
double rounding_variance(const DensePoints& points);

} // namespace fettle::fit
