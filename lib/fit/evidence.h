#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// Touches z = H β + g + e of a Gaussian random field: β free but for a prior, g ~ N(0, τ² R), e ~ N(0, σ² I).
struct FieldModel {
    Eigen::MatrixXd free;  ///< columns of H whose β nothing is known about
    Eigen::MatrixXd prior; ///< covariance of the other columns' share, n x n
    Eigen::MatrixXd R;     ///< n x n, of g for τ = 1
    double sigma = 0;      ///< of one touch
    double least_tau = 0;  ///< what τ is expected to reach at least
};

/// What the touches say of τ.
struct Amplitude {
    double rms = 0;                         ///< √ of the expected τ²
    std::vector<Eigen::Index> gross_errors; ///< touches that were left out: better explained as slips
};

/// The probability of each τ given the touches, the free β integrated out (restricted likelihood, Patterson and
/// Thompson 1971). Before the touches all orders of magnitude above `least_tau` are equally probable, smaller ones ever
/// less. The expectation, not the most probable τ:
/// few touches leave room for rougher surfaces, which a standard deviation has to cover. Touches that are better
/// explained as gross errors are left out one by one, while more than `spare` redundant ones remain.
Amplitude amplitude(const FieldModel& model, const Eigen::VectorXd& z, Eigen::Index spare);

} // namespace fettle
