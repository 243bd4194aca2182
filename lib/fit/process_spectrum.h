#pragma once

#include "fit/correlation.h"
#include "fit/family_solution.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace fettle {

/// Touches z = F β + g + e: a trend, a Gaussian process, noise.
struct ProcessTouches {
    Eigen::Matrix2Xd xy; ///< mm
    Eigen::VectorXd z;   ///< mm
    double sigma = 0;    ///< of e, mm
    Eigen::MatrixXd F;   ///< n x p, of the trend
};

ProcessTouches part_of(const ProcessTouches& all, const Columns& kept);

inline constexpr int kRatios = 25;

/// The i-th amplitude τ over σ, i < kRatios: from what the touches cannot see to what bends as much as they do over the
/// longest correlation.
double ratio_of(int i);

/// One correlation, as independent numbers: with E the directions in which the trend cannot move the touches, y = Eᵀ z
/// / σ, y_i ~ N(0, 1 + (τ/σ)² λ_i).
struct Spectrum {
    Correlation correlation;
    Eigen::MatrixXd E; ///< n x (n - p)
    Eigen::VectorXd lambda, y;
    std::array<double, kRatios> score; ///< for each τ, as the families': -2 ln restricted likelihood + p ln n
};

/// All correlations and amplitudes: one decomposition a correlation.
std::vector<Spectrum> spectra(const ProcessTouches& touches);

/// Of the y, for each unit of σ².
Eigen::VectorXd precision(const Spectrum& s, double ratio);

/// The least of all.
double best_score(const std::vector<Spectrum>& all);

} // namespace fettle
