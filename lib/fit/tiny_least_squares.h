#pragma once

#include <Eigen/Core>

#include <functional>

namespace fettle::fit {

/// Residuals as a function of few parameters.
struct ResidualFunction {
    int count = 0;
    int parameters = 0;
    /// Column-major `jacobian`, count x parameters; it may be null.
    std::function<void(const double* x, double* residuals, double* jacobian)> evaluate;
};

/// The minimum of a sum of squares.
struct Minimum {
    Eigen::VectorXd x;
    double cost = 0; ///< half the sum of squares
    bool converged = false;
    int iterations = 0;
};

/// Least squares of few parameters by Levenberg and Marquardt (ceres::TinySolver), but for the last digits.
/// @param residuals  dimensionless, of parameters of the order of 1
Minimum levenberg_marquardt(const ResidualFunction& residuals, const Eigen::VectorXd& start);

/// Refines a solution beyond relative changes of 1e-8, to rounding accuracy.
Eigen::VectorXd refine_minimum(const ResidualFunction& residuals, Eigen::VectorXd x);

} // namespace fettle::fit
