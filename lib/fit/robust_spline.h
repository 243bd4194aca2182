#pragma once

#include "fit/dense_points.h"
#include "fit/smoothing.h"

#include <Eigen/Core>

#include <string>

namespace fettle::fit {

// E[w x²] / E[w] of normal errors x of variance 1, with the weights w of Tukey's biweight (Holland and Welsch 1977).
inline constexpr double kBiweightVariance = 0.8280730;

/// What one pass over all points gives.
struct SplinePass {
    NormalEquations equations;
    Eigen::MatrixXd weights; ///< Σ s w of each cell
    Eigen::MatrixXd heights; ///< robust mean height of each cell's points, brought to its middle, mm
    std::size_t outliers = 0;
};

/// The re-weighted fit of fit_dense() (dense.h): Tukey's weights, λ of maximum likelihood.
struct RobustSpline {
    surface::Bspline spline; ///< without the trend
    Eigen::VectorXd trend;   ///< control heights of a quadratic
    double sigma = 0;        ///< standard deviation of a point, mm
    double lambda = 0;
    double change = 0; ///< rms change of the surface in the last pass, mm
    int passes = 0;
    PointCounts counts;
    SplinePass last; ///< its λ maximises the likelihood
    SplineEnergy energy;

    bool converged() const;
    surface::Bspline with_trend() const;
    surface::Bspline trend_alone() const;
};

/// @throws InputError as estimate_dense_start()
RobustSpline fit_robust_spline(const DensePoints& points, const std::string& name);

} // namespace fettle::fit
