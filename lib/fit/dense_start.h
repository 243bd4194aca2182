#pragma once

#include "fit/dense_points.h"
#include "fit/smoothing.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// A surface near the greater part of the points in each neighbourhood, for the redescending weights to begin at.
struct DenseStart {
    Eigen::Matrix<double, 6, 1> trend; ///< the quadratic of least squares (spline_energy.h, Quadratics)
    Bspline spline;                    ///< on the grid; without the trend
    double sigma = 0;                  ///< of a point, from the median residual, mm
    double lambda = 0;                 ///< of `spline` (smoothing.h)
    PointCounts counts;
};

/// From a few points of each cell, drawn by their number (Waterman's reservoir), so that dense patches do not outweigh
/// the rest. Least absolute deviations, by weights 1/|r|, on ever finer grids: the problem is convex, so a detail that
/// the greater part of its points agree on is found wherever the coarser grids left it.
/// @throws InputError if the points do not determine a quadratic
DenseStart dense_start(const DensePoints& points, const std::string& name);

/// Factors that keep a dense patch from outweighing its surroundings: a cell counts at most kDensest times as much as
/// the median of those that have points.
Eigen::MatrixXd density_factors(const Eigen::MatrixXd& weights);
inline constexpr double kDensest = 4;

/// Variance of the residuals that rounding leaves: coordinates in F4 are wrong by up to 2^-25 of their size.
double rounding_variance(const DensePoints& points);

} // namespace fettle
