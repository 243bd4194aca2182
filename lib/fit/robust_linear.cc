#include "fit/robust_linear.h"

#include "fit/fit.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

namespace fettle::fit {

namespace {

/// Residuals A x - b of one block of parameters.
class LinearCost : public ceres::CostFunction {
  public:
    LinearCost(Eigen::MatrixXd A, Eigen::VectorXd b) : A_(std::move(A)), b_(std::move(b))
    {
        set_num_residuals(static_cast<int>(A_.rows()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(A_.cols()));
    }

    bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override
    {
        const Eigen::Map<const Eigen::VectorXd> x(parameters[0], A_.cols());
        Eigen::Map<Eigen::VectorXd>(residuals, A_.rows()) = A_ * x - b_;
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        if (jacobians != nullptr && jacobians[0] != nullptr)
            Eigen::Map<RowMajor>(jacobians[0], A_.rows(), A_.cols()) = A_;
        return true;
    }

  private:
    Eigen::MatrixXd A_;
    Eigen::VectorXd b_;
};

} // namespace

RobustLinearResult solve_robust(const RobustLinear& problem)
{
    RobustLinearResult result;
    result.x = Eigen::VectorXd::Zero(problem.A.cols());
    ceres::Problem ceres_problem;
    for (Eigen::Index i = 0; i < problem.A.rows(); ++i)
        ceres_problem.AddResidualBlock(new LinearCost(problem.A.row(i), problem.b.segment(i, 1)),
                                       new ceres::HuberLoss(problem.width), result.x.data());
    const Eigen::MatrixXd prior = problem.prior.asDiagonal();
    ceres_problem.AddResidualBlock(new LinearCost(prior, Eigen::VectorXd::Zero(prior.rows())), nullptr,
                                   result.x.data());
    FLAGS_minloglevel = google::GLOG_FATAL; // stderr is for the tool's messages; the summary says the same
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR; // the prior of a nearly quadratic surface is stiff
    options.num_threads = 1;                      // the same digits for any --threads
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 200;
    options.initial_trust_region_radius = 1e16; // Gauss-Newton steps are exact while no residual crosses the width
    options.max_trust_region_radius = 1e20;
    options.function_tolerance = 1e-15;  // of the cost, which is of the order of the number of touches: rounding
    options.parameter_tolerance = 1e-13; // of x: rounding, enlarged by the condition of the problem
    options.gradient_tolerance = 1e-12;  // far below 1, as rows are in standard deviations
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_problem, &summary);
    result.converged = summary.termination_type == ceres::CONVERGENCE;
    result.iterations = static_cast<int>(summary.iterations.size());
    result.weight =
        (problem.A * result.x - problem.b).unaryExpr([&](double r) { return huber_weight(r, problem.width); });
    return result;
}

} // namespace fettle::fit
