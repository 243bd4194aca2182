#include "fit/tiny_least_squares.h"

#include "core/decompositions.h"

#include <ceres/tiny_solver.h>

namespace fettle::fit {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Adapter to the function concept of ceres::TinySolver.
struct TinySolverFunction {
    using Scalar = double;
    enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

    const ResidualFunction& residuals;

    int NumResiduals() const { return residuals.count; }
    int NumParameters() const { return residuals.parameters; }
    bool operator()(const double* x, double* values, double* jacobian) const
    {
        residuals.evaluate(x, values, jacobian);
        return true;
    }
};

} // namespace

Minimum levenberg_marquardt(const ResidualFunction& residuals, const VectorXd& start)
{
    constexpr double kCostTolerance = 1e-10;     // relative; refine_minimum() removes the remaining error
    constexpr double kRoundingTolerance = 1e-12; // for the parameters and the gradient
    constexpr int kMaxIterations = 50;           // ten are common; tori on a sphere's touches do not converge
    using Solver = ceres::TinySolver<TinySolverFunction>;
    Solver solver;
    solver.options.max_num_iterations = kMaxIterations;
    solver.options.function_tolerance = kCostTolerance;
    solver.options.parameter_tolerance = kRoundingTolerance;
    solver.options.gradient_tolerance = kRoundingTolerance;
    solver.options.cost_threshold = kRoundingTolerance * kRoundingTolerance;
    VectorXd x = start;
    const Solver::Summary& summary = solver.Solve(TinySolverFunction{residuals}, &x);
    return {x, summary.final_cost, summary.status != Solver::HIT_MAX_ITERATIONS, summary.iterations};
}

// The solver cannot see relative changes below 1e-8 since it compares rounded costs: Gauss-Newton steps. These do not
// converge where the residuals are large; one Newton step, with second derivatives by central differences, then
// replaces them.
VectorXd refine_minimum(const ResidualFunction& residuals, VectorXd x)
{
    constexpr int kMaxSteps = 4;
    constexpr double kMaxStep = 1e-5; // larger steps are not refinements; each must be smaller than the one before
    constexpr double kStepTolerance = 1e-12;
    VectorXd values(residuals.count);
    MatrixXd jacobian(residuals.count, residuals.parameters);
    double last = kMaxStep;
    for (int i = 0; i < kMaxSteps && last > kStepTolerance; ++i) {
        residuals.evaluate(x.data(), values.data(), jacobian.data());
        const VectorXd step = core::least_squares_by_qr(jacobian, values).x;
        if (!(step.norm() < last)) break;
        last = step.norm();
        x -= step;
    }
    if (last <= kStepTolerance) return x;
    const auto gradient = [&](const VectorXd& at) -> VectorXd {
        residuals.evaluate(at.data(), values.data(), jacobian.data());
        return jacobian.transpose() * values;
    };
    MatrixXd hessian(residuals.parameters, residuals.parameters);
    for (int k = 0; k < residuals.parameters; ++k) {
        constexpr double kFiniteDifferenceStep =
            1e-5; // rounding, 1e-16 / 1e-5, and truncation, 1e-10, are both far below 1
        const VectorXd step = kFiniteDifferenceStep * VectorXd::Unit(residuals.parameters, k);
        hessian.col(k) = (gradient(x + step) - gradient(x - step)) / (2 * kFiniteDifferenceStep);
    }
    const VectorXd step = core::least_squares_by_qr(hessian, gradient(x)).x;
    if (step.norm() < kMaxStep) x -= step;
    return x;
}

} // namespace fettle::fit
