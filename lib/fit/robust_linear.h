#pragma once

#include <Eigen/Core>

namespace fettle {

/// minimise  ½ Σ ρ((A x - b)_i²) + ½ Σ (prior_j x_j)²,  ρ Huber's loss of the given width. Rows are in units of their
/// standard deviation.
struct RobustLinear {
    Eigen::MatrixXd A;
    Eigen::VectorXd b;
    double width = 0;
    Eigen::VectorXd prior; ///< 0: x_j is free
};

struct RobustLinearResult {
    Eigen::VectorXd x;
    Eigen::VectorXd weight; ///< of each row at the solution
    bool converged = false;
    int iterations = 0;
};

/// With Ceres; the problem is convex, so the solution is the only one.
RobustLinearResult solve(const RobustLinear& problem);

} // namespace fettle
