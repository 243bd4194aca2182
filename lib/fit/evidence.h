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
};

/// Amplitude τ that makes the touches most probable, the free β integrated out (restricted maximum likelihood,
/// Patterson and Thompson 1971). At least so large that g is not quite impossible, at most that noise is.
double most_probable_amplitude(const FieldModel& model, const Eigen::VectorXd& z);

/// Touches that are better explained as gross errors, one by one, while at least `spare` redundant touches remain.
std::vector<Eigen::Index> gross_errors(const FieldModel& model, const Eigen::VectorXd& z, Eigen::Index spare);

/// The model of some of the touches.
FieldModel part_of(const FieldModel& model, const std::vector<Eigen::Index>& kept);

} // namespace fettle
