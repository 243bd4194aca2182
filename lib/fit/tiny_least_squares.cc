#include "fit/tiny_least_squares.h"

#include "core/decompositions.h"

#include <ceres/tiny_solver.h>

namespace fettle {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// As ceres::TinySolver takes them.
struct Function {
    using Scalar = double;
    enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

    const Residuals& residuals;

    int NumResiduals() const { return residuals.count; }
    int NumParameters() const { return residuals.parameters; }
    bool operator()(const double* x, double* values, double* jacobian) const
    {
        residuals.evaluate(x, values, jacobian);
        return true;
    }
};

/// The solver compares costs, whose rounding hides changes of 1e-8: Gauss and Newton's steps go on from there. Where
/// the residuals are large these do not settle, and the last one is Newton's, second derivatives by differences.
VectorXd polished(const Residuals& residuals, VectorXd x)
{
    constexpr int kSteps = 4;
    constexpr double kPolish = 1e-5; // larger steps are none; each must be smaller than the one before
    constexpr double kSettled = 1e-12;
    VectorXd values(residuals.count);
    MatrixXd jacobian(residuals.count, residuals.parameters);
    double last = kPolish;
    for (int i = 0; i < kSteps && last > kSettled; ++i) {
        residuals.evaluate(x.data(), values.data(), jacobian.data());
        const VectorXd step = least_squares_by_qr(jacobian, values).x;
        if (!(step.norm() < last)) break;
        last = step.norm();
        x -= step;
    }
    if (last <= kSettled) return x;
    const auto gradient = [&](const VectorXd& at) -> VectorXd {
        residuals.evaluate(at.data(), values.data(), jacobian.data());
        return jacobian.transpose() * values;
    };
    MatrixXd hessian(residuals.parameters, residuals.parameters);
    for (int k = 0; k < residuals.parameters; ++k) {
        constexpr double kStep = 1e-5; // rounding, 1e-16 / 1e-5, and truncation, 1e-10, are both far below 1
        const VectorXd step = kStep * VectorXd::Unit(residuals.parameters, k);
        hessian.col(k) = (gradient(x + step) - gradient(x - step)) / (2 * kStep);
    }
    const VectorXd step = least_squares_by_qr(hessian, gradient(x)).x;
    if (step.norm() < kPolish) x -= step;
    return x;
}

} // namespace

Minimum least_squares(const Residuals& residuals, const VectorXd& start)
{
    constexpr double kNoChange = 1e-10; // of the sum of squares; what is left is polished
    constexpr double kRounding = 1e-12; // of the parameters, and of the gradient
    constexpr int kIterations = 50;     // ten are common; tori on a sphere's touches find no end
    using Solver = ceres::TinySolver<Function>;
    Solver solver;
    solver.options.max_num_iterations = kIterations;
    solver.options.function_tolerance = kNoChange;
    solver.options.parameter_tolerance = kRounding;
    solver.options.gradient_tolerance = kRounding;
    solver.options.cost_threshold = kRounding * kRounding;
    VectorXd x = start;
    const Solver::Summary& summary = solver.Solve(Function{residuals}, &x);
    return {polished(residuals, x), summary.final_cost, summary.status != Solver::HIT_MAX_ITERATIONS,
            summary.iterations};
}

} // namespace fettle
