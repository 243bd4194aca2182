#pragma once

#include <Eigen/Core>

namespace fettle::fit {

/// Stationary kernels of a Gaussian process (Rasmussen and Williams 2006, 4.2). The squared exponential is infinitely
/// differentiable; Matérn's with ν = 5/2 is twice differentiable and extrapolates waves between the touches less far
/// into the anomaly.
enum class Kernel { squared_exponential, matern52 };

struct Correlation {
    Kernel kernel = Kernel::squared_exponential;
    double length = 0; ///< ℓ, mm
};

/// The correlation at distances given by their squares, mm²: exp(-|Δ|²/2ℓ²), or Matérn's.
Eigen::ArrayXd correlation_at(const Correlation& correlation, const Eigen::ArrayXd& squared_distances);

/// @param a, b  places in x-y, mm  @return  mm², a row for each of a, a column for each of b
Eigen::MatrixXd squared_distances(const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b);

/// Correlations of places, from their squared_distances() or from themselves.
Eigen::MatrixXd correlation_matrix(const Correlation& correlation, const Eigen::MatrixXd& squared_distances);
Eigen::MatrixXd correlation_matrix(const Correlation& correlation, const Eigen::Matrix2Xd& a,
                                   const Eigen::Matrix2Xd& b);

} // namespace fettle::fit
