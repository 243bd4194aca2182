#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::fit {

/// Linear mixed model of n touches z = H β + g + e with a Gaussian random field g ~ N(0, τ² R) and noise e ~ N(0, σ²
/// I).
struct FieldModel {
    Eigen::MatrixXd fixed_effects;     ///< columns of H whose β has a flat prior
    Eigen::MatrixXd effect_covariance; ///< prior covariance of the heights from the other columns, n x n
    Eigen::MatrixXd R;                 ///< n x n, covariance of g for τ = 1
    double sigma = 0;                  ///< standard deviation of a touch
    double min_tau = 0;                ///< lower scale of τ: the prior probability of smaller ones falls off
};

/// The amplitude of the random field, estimated from the touches.
struct Amplitude {
    double rms = 0;                     ///< square root of the posterior mean of τ²
    std::vector<Eigen::Index> outliers; ///< indices of touches that were left out
};

/// Posterior mean of τ² by the restricted likelihood (Patterson and Thompson 1971). The prior is uniform in ln τ above
/// `min_tau` and decreases below. The mean is taken instead of the mode since few touches leave room for rougher
/// surfaces, which a standard deviation has to cover. Touches that are better explained as outliers are left out one by
/// one, as long as more than `min_redundancy` redundant ones remain.
Amplitude estimate_amplitude(const FieldModel& model, const Eigen::VectorXd& z, Eigen::Index min_redundancy);

} // namespace fettle::fit
