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

/// The solver compares costs, whose rounding hides changes of 1e-8: Gauss and Newton's steps go on from there. Where
/// the residuals are large these do not settle, and the last one is Newton's, second derivatives by differences.
template <typename Function, int P>
Eigen::Matrix<double, P, 1> polished(const Function& function, Eigen::Matrix<double, P, 1> x)
{
    constexpr int kSteps = 4;
    constexpr double kPolish = 1e-5; // larger steps are none; each must be smaller than the one before
    constexpr double kSettled = 1e-12;
    Eigen::VectorXd residuals(function.NumResiduals());
    Eigen::MatrixXd jacobian(function.NumResiduals(), P);
    double last = kPolish;
    for (int i = 0; i < kSteps && last > kSettled; ++i) {
        function(x.data(), residuals.data(), jacobian.data());
        const Eigen::VectorXd step = jacobian.colPivHouseholderQr().solve(residuals);
        if (!(step.norm() < last)) break;
        last = step.norm();
        x -= step;
    }
    if (last <= kSettled) return x;
    const auto gradient = [&](const Eigen::Matrix<double, P, 1>& at) -> Eigen::VectorXd {
        function(at.data(), residuals.data(), jacobian.data());
        return jacobian.transpose() * residuals;
    };
    Eigen::MatrixXd hessian(P, P);
    for (int k = 0; k < P; ++k) {
        constexpr double kStep = 1e-5; // rounding, 1e-16 / 1e-5, and truncation, 1e-10, are both far below 1
        const Eigen::Matrix<double, P, 1> step = kStep * Eigen::Matrix<double, P, 1>::Unit(k);
        hessian.col(k) = (gradient(x + step) - gradient(x - step)) / (2 * kStep);
    }
    const Eigen::VectorXd step = hessian.colPivHouseholderQr().solve(gradient(x));
    if (step.norm() < kPolish) x -= step;
    return x;
}

/// Least squares of few parameters by Levenberg and Marquardt (Ceres), polished.
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
    return {polished(function, x), summary.final_cost,
            summary.status != ceres::TinySolver<Function>::HIT_MAX_ITERATIONS, summary.iterations};
}

} // namespace fettle
