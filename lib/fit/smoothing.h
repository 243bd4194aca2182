#pragma once

#include "surface/band.h"
#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle::fit {

/// Normal equations of the weighted residuals r of points from a spline, for a correction of its control heights. g are
/// the basis functions at a point.
struct NormalEquations {
    surface::BandMatrix matrix; ///< Σ w g gᵀ
    Eigen::VectorXd right_side; ///< Σ w r g, mm
    double square_sum = 0;      ///< Σ w r², mm²
    double weight_sum = 0;      ///< Σ w
    double min_square_sum = 0;  ///< lower bound of Σ w r² due to rounding, mm²
};

/// The matrix K of the third-derivative energy E(f) = cᵀ K c of a grid's control heights c (spline_energy.h).
struct SplineEnergy {
    surface::BandMatrix K;
    double trace = 0;
};
SplineEnergy spline_energy_matrix(const surface::Bspline& grid);

struct SmoothedSpline {
    Eigen::VectorXd heights; ///< control heights
    double lambda = 0;       ///< σ²/τ², the weight of the energy against Σ w r²
    double variance = 0;     ///< σ² of a point of weight 1, mm²
    double change = 0;       ///< rms of the correction at the points, mm
};

/// The spline that minimises Σ w (z - f)² + λ E(f).
/// @param heights  control heights of the spline that the residuals are measured from, minus any quadratic (which has
///                 no energy)
SmoothedSpline smooth_spline(const NormalEquations& equations, const Eigen::VectorXd& heights,
                             const SplineEnergy& energy, double lambda);

/// The λ below which rounding swallows the energy that bridges gaps.
double min_lambda(const NormalEquations& equations, const SplineEnergy& energy);

/// The spline with the λ of maximum marginal likelihood, σ² being the most probable one for each λ (restricted
/// likelihood: Patterson and Thompson 1971; of a spline: Wahba 1990, 4.8).
/// @param start  initial λ; 0: a default
SmoothedSpline smooth_spline_by_likelihood(const NormalEquations& equations, const Eigen::VectorXd& heights,
                                           const SplineEnergy& energy, double start);

} // namespace fettle::fit
