#pragma once

#include <ceres/tiny_solver.h>
#include <Eigen/QR>

namespace fettle {

/// Where a sum of squares is least.
template <int P>
struct Minimum {
    Eigen::Matrix<double, P, 1> x;
    double cost = 0; ///< half the sum
    bool converged = false;
    int iterations = 0;
};

/// Least squares of few parameters by Levenberg and Marquardt (Ceres), then by Gauss and Newton's steps: the solver
/// compares costs, whose rounding hides changes of 1e-8.
/// @param function  as ceres::TinySolver takes it, of P parameters of the order of 1 and dimensionless residuals
template <typename Function, int P = Function::NUM_PARAMETERS>
Minimum<P> least_squares(const Function& function, Eigen::Matrix<double, P, 1> x)
{
    constexpr double kNoChange = 1e-16; // of the sum of squares
    constexpr double kRounding = 1e-12; // of the parameters, and of the gradient
    constexpr int kIterations = 100;    // ten are common
    ceres::TinySolver<Function> solver;
    solver.options.max_num_iterations = kIterations;
    solver.options.function_tolerance = kNoChange;
    solver.options.parameter_tolerance = kRounding;
    solver.options.gradient_tolerance = kRounding;
    solver.options.cost_threshold = kRounding * kRounding;
    const auto& summary = solver.Solve(function, &x);

    constexpr int kSteps = 4;
    double last = 1e-5; // larger steps are no polish; each must be smaller than the one before
    Eigen::VectorXd residuals(function.NumResiduals());
    Eigen::Matrix<double, Eigen::Dynamic, P> jacobian(function.NumResiduals(), P);
    for (int i = 0; i < kSteps; ++i) {
        function(x.data(), residuals.data(), jacobian.data());
        const Eigen::Matrix<double, P, 1> step = jacobian.colPivHouseholderQr().solve(residuals);
        if (!(step.norm() < last)) break;
        last = step.norm();
        x -= step;
    }
    return {x, summary.final_cost, summary.status != ceres::TinySolver<Function>::HIT_MAX_ITERATIONS,
            summary.iterations};
}

} // namespace fettle
