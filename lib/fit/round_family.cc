#include "fit/round_family.h"

#include "fit/tiny_least_squares.h"
#include "surface/revolution.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::VectorXd;

/// Indices of a family's free parameters; a sphere has one curvature.
std::vector<int> free_parameters(RoundFamily family, bool given_direction)
{
    std::vector<int> free = {surface::kOffset, surface::kTiltAcross, surface::kTiltAlong};
    if (family != RoundFamily::sphere && !given_direction) free.push_back(surface::kTurn);
    free.push_back(surface::kCurvatureAround);
    if (family == RoundFamily::cone || family == RoundFamily::torus) free.push_back(surface::kLean);
    if (family == RoundFamily::torus) free.push_back(surface::kCurvatureAlong);
    return free;
}

/// Weighted orthogonal distances of the touches, lengths in units of their extent.
struct WeightedDistances {
    RoundFamily family;
    std::vector<int> free;
    Eigen::MatrixX3d points; ///< in the frame, one in each row
    VectorXd weight;

    surface::RevolutionParameters theta(const double* x) const
    {
        surface::RevolutionParameters all = surface::RevolutionParameters::Zero();
        for (std::size_t k = 0; k < free.size(); ++k) all[free[k]] = x[k];
        if (family == RoundFamily::sphere) all[surface::kCurvatureAlong] = all[surface::kCurvatureAround];
        return all;
    }

    void operator()(const double* x, double* residuals, double* jacobian) const
    {
        // There is no distance beyond the centre of curvature; this residual makes the solver reject the step.
        constexpr double kRejectedDistance = 1e6;
        const Index n = points.rows();
        surface::RevolutionJacobian by_parameters(jacobian == nullptr ? 0 : n, surface::kRevolutionParameterCount);
        surface::distances(surface::make_revolution(theta(x)), points, residuals,
                           jacobian == nullptr ? nullptr : &by_parameters);
        if (jacobian != nullptr) {
            if (family == RoundFamily::sphere)
                by_parameters.col(surface::kCurvatureAround) += by_parameters.col(surface::kCurvatureAlong);
            for (Index i = 0; i < n; ++i)
                if (std::isnan(residuals[i])) by_parameters.row(i).setZero();
            for (std::size_t k = 0; k < free.size(); ++k)
                VectorXd::Map(jacobian + static_cast<Index>(k) * n, n) =
                    weight.cwiseProduct(by_parameters.col(free[k]));
        }
        for (Index i = 0; i < n; ++i)
            residuals[i] = weight[i] * (std::isnan(residuals[i]) ? kRejectedDistance : residuals[i]);
    }
};

/// The problem with lengths in units of the touches' extent.
struct ScaledProblem {
    WeightedDistances distances;
    double extent; ///< mm

    ResidualFunction residuals() const
    {
        return {static_cast<int>(distances.points.rows()), static_cast<int>(distances.free.size()),
                std::cref(distances)};
    }
};

ScaledProblem scaled(RoundFamily family, const RoundProblem& problem)
{
    ScaledProblem result{{family, free_parameters(family, problem.given_direction), {}, {}}, 0};
    const Matrix3Xd points = problem.frame.axes.transpose() * (problem.touches.colwise() - problem.frame.point);
    result.extent = points.cwiseAbs().maxCoeff();
    result.distances.points = points.transpose() / result.extent;
    result.distances.weight = problem.weight * result.extent;
    return result;
}

/// Parameters of lengths in mm from those of lengths in another unit, and the other way with its inverse.
VectorXd in_unit(VectorXd theta, double unit)
{
    theta[surface::kOffset] *= unit;
    theta[surface::kCurvatureAround] /= unit;
    theta[surface::kCurvatureAlong] /= unit;
    return theta;
}

} // namespace

int parameter_count(RoundFamily family, bool given_direction)
{
    return static_cast<int>(free_parameters(family, given_direction).size());
}

RoundSolution solve_round(RoundFamily family, const RoundProblem& problem, VectorXd start)
{
    const ScaledProblem in_extent = scaled(family, problem);
    start = in_unit(std::move(start), 1 / in_extent.extent);
    const Minimum minimum = levenberg_marquardt(in_extent.residuals(), start(in_extent.distances.free));

    RoundSolution solution;
    solution.theta = in_unit(in_extent.distances.theta(minimum.x.data()), in_extent.extent);
    const bool is_finite = minimum.x.allFinite() && std::isfinite(minimum.cost);
    solution.cost = is_finite ? minimum.cost : std::numeric_limits<double>::infinity();
    solution.converged = minimum.converged;
    solution.iterations = minimum.iterations;
    return solution;
}

void refine_round(RoundFamily family, const RoundProblem& problem, RoundSolution& solution)
{
    const ScaledProblem in_extent = scaled(family, problem);
    const VectorXd start = in_unit(solution.theta, 1 / in_extent.extent)(in_extent.distances.free);
    const VectorXd x = refine_minimum(in_extent.residuals(), start);
    solution.theta = in_unit(in_extent.distances.theta(x.data()), in_extent.extent);
    if (!x.allFinite()) solution.cost = std::numeric_limits<double>::infinity();
}

surface::Shape round_shape(RoundFamily family, const RoundFrame& frame, const VectorXd& theta)
{
    const Eigen::Vector3d a = Eigen::Vector3d(1, theta[surface::kTurn], -theta[surface::kTiltAlong]).normalized();
    const Eigen::Vector3d up(0, theta[surface::kTiltAcross], 1);
    const Eigen::Vector3d n = (up - up.dot(a) * a).normalized();
    const Eigen::Vector3d point = frame.point + theta[surface::kOffset] * frame.axes.col(2);
    const Eigen::Vector3d normal = frame.axes * n, axis = frame.axes * a;
    switch (family) {
    case RoundFamily::sphere:
        return surface::Sphere{point, normal, theta[surface::kCurvatureAround]};
    case RoundFamily::cylinder:
        return surface::Cylinder{point, normal, axis, theta[surface::kCurvatureAround]};
    case RoundFamily::cone:
        return surface::Cone{point, normal, axis, theta[surface::kCurvatureAround], theta[surface::kLean]};
    default:
        return surface::Torus{point,
                              normal,
                              axis,
                              theta[surface::kCurvatureAround],
                              theta[surface::kLean],
                              theta[surface::kCurvatureAlong]};
    }
}

} // namespace fettle::fit
