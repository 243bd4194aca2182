#pragma once

#include "fit/correlation.h"
#include "fit/family_solution.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace fettle::fit {

/// Touches z = F β + g + e with a trend F β, a Gaussian process g and noise e.
struct ProcessTouches {
    Eigen::Matrix2Xd xy; ///< mm
    Eigen::VectorXd z;   ///< mm
    double sigma = 0;    ///< standard deviation of e, mm
    Eigen::MatrixXd F;   ///< n x p, the trend's functions at the touches
};

ProcessTouches subset_of(const ProcessTouches& all, const TouchIndices& kept);

inline constexpr int kNumRatios = 25;

/// The i-th amplitude τ over σ, i < kNumRatios: from undetectable in the touches to a curvature like theirs at the
/// longest correlation length.
double amplitude_ratio(int i);

/// The touches decorrelated for one correlation: y = Eᵀ z / σ with orthonormal columns E orthogonal to the trend, so
/// that y_i ~ N(0, 1 + (τ/σ)² λ_i) independently.
struct Spectrum {
    Correlation correlation;
    Eigen::MatrixXd E; ///< n x (n - p)
    Eigen::VectorXd lambda, y;
    std::array<double, kNumRatios> score; ///< -2 ln restricted likelihood + p ln n for each τ
};

/// The spectra of all correlations. One decomposition serves all amplitudes of a correlation.
std::vector<Spectrum> compute_spectra(const ProcessTouches& touches);

/// Sets the scores for a noise of `factor` times that of the touches, which y and λ stay in units of. They lack
/// 2 (n - p) ln factor. @param trend  number p of the trend's functions
void set_scores(Spectrum& s, double factor, Eigen::Index trend);

/// Inverse variances of the y.
Eigen::VectorXd precision(const Spectrum& s, double ratio);

double min_score(const std::vector<Spectrum>& all);

} // namespace fettle::fit
