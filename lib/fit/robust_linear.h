#pragma once

#include <Eigen/Core>

namespace fettle::fit {

/// The problem  min ½ Σ ρ((A x - b)_i²) + ½ Σ (prior_j x_j)²  with Huber's loss ρ. Rows are in units of their standard
/// deviation.
struct RobustLinear {
    Eigen::MatrixXd A;
    Eigen::VectorXd b;
    double width = 0;      ///< of Huber's loss, in standard deviations
    Eigen::VectorXd prior; ///< 1 / prior standard deviation of each x_j; 0: flat prior
};

struct RobustLinearResult {
    Eigen::VectorXd x;
    Eigen::VectorXd weight; ///< Huber's weight of each row at the solution
    bool converged = false;
    int iterations = 0;
};

/// Solves the problem with Ceres. It is convex, so the minimum is the global one.
RobustLinearResult solve_robust(const RobustLinear& problem);

} // namespace fettle::fit
