#pragma once

#include <Eigen/Core>

#include <functional>

namespace fettle {

/// Residuals of few parameters. `jacobian` may be null; it is column by column, a column a parameter.
struct Residuals {
    int count = 0;
    int parameters = 0;
    std::function<void(const double* x, double* residuals, double* jacobian)> evaluate;
};

/// Where a sum of squares is least.
struct Minimum {
    Eigen::VectorXd x;
    double cost = 0; ///< half the sum
    bool converged = false;
    int iterations = 0;
};

/// Least squares of few parameters by Levenberg and Marquardt (Ceres), polished to rounding.
/// @param residuals  dimensionless, of parameters of the order of 1
Minimum least_squares(const Residuals& residuals, const Eigen::VectorXd& start);

} // namespace fettle
