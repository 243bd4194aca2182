#pragma once

#include "surface/band.h"
#include "surface/surface.h"

#include <Eigen/Core>

namespace fettle {

/// Weighted residuals of a spline that is to be improved, as normal equations.
struct NormalEquations {
    BandMatrix matrix;       ///< Σ w g gᵀ
    Eigen::VectorXd right;   ///< Σ w r g, r the residuals against `heights`
    double square = 0;       ///< Σ w r², mm²
    double weight = 0;       ///< Σ w
    double least_square = 0; ///< of the residuals that rounding leaves, mm²
};

/// E, the energy of the third derivatives, of a grid's control heights (spline_energy.h).
struct Energy {
    BandMatrix K;
    double trace = 0;
};
Energy energy_over(const Bspline& grid);

struct Smoothed {
    Eigen::VectorXd heights; ///< control heights
    double lambda = 0;       ///< σ²/τ²: of the energy against Σ w r²
    double variance = 0;     ///< σ² of a point of weight 1, mm²
    double change = 0;       ///< root mean square of the change at the points, mm
};

/// The spline that minimises Σ w (z - f)² + λ E(f).
/// @param heights  control heights that the residuals belong to, less a quadratic (which has no energy)
Smoothed smoothed(const NormalEquations& equations, const Eigen::VectorXd& heights, const Energy& energy,
                  double lambda);

/// Below this λ what bridges a gap is lost in rounding.
double least_lambda(const NormalEquations& equations, const Energy& energy);

/// smoothed() with the λ of the largest marginal likelihood, σ² being that which is most probable for it (restricted
/// likelihood: Patterson and Thompson 1971; of a spline: Wahba 1990, 4.8).
/// @param start  λ to begin at; 0: anywhere
Smoothed smoothed_by_likelihood(const NormalEquations& equations, const Eigen::VectorXd& heights, const Energy& energy,
                                double start);

} // namespace fettle
