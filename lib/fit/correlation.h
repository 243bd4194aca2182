#pragma once

#include <Eigen/Core>

namespace fettle {

/// Smooth without end (squared exponential), or twice differentiable (Matérn's of 5/2), which trusts waves less to go
/// on beneath the anomaly as they do between the touches.
enum class Roughness { none, matern };

struct Correlation {
    Roughness roughness = Roughness::none;
    double length = 0; ///< mm
};

/// At distances whose squares are given, mm²: exp(-|Δ|²/2ℓ²), or Matérn's of 5/2 (Rasmussen and Williams 2006, 4.2).
Eigen::ArrayXd at(const Correlation& correlation, const Eigen::ArrayXd& squares);

/// @param a, b  places in x-y, mm  @return  a row for each of a, a column for each of b
Eigen::MatrixXd correlations(const Correlation& correlation, const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b);

} // namespace fettle
