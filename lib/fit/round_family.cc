#include "fit/round_family.h"

#include "fit/tiny_least_squares.h"
#include "surface/revolution.h"

#include <cmath>
#include <functional>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::VectorXd;

/// Free parameters of a family; a sphere has one curvature.
std::vector<int> free_parameters(RoundFamily family, bool given_direction)
{
    std::vector<int> free = {kOffset, kTiltAcross, kTiltAlong};
    if (family != RoundFamily::sphere && !given_direction) free.push_back(kTurn);
    free.push_back(kAround);
    if (family == RoundFamily::cone || family == RoundFamily::torus) free.push_back(kLean);
    if (family == RoundFamily::torus) free.push_back(kAlong);
    return free;
}

void close(RoundFamily family, RevolutionParameters& theta)
{
    if (family == RoundFamily::sphere) theta[kAlong] = theta[kAround];
}

/// Distances of the touches, in units of their extent.
struct Distances {
    RoundFamily family;
    std::vector<int> free;
    Matrix3Xd points; ///< in the frame
    VectorXd weight;

    RevolutionParameters theta(const double* x) const
    {
        RevolutionParameters all = RevolutionParameters::Zero();
        for (std::size_t k = 0; k < free.size(); ++k) all[free[k]] = x[k];
        close(family, all);
        return all;
    }

    void operator()(const double* x, double* residuals, double* jacobian) const
    {
        // Beyond the centre there is no distance: so bad that the step is taken back.
        constexpr double kFar = 1e6;
        const Revolution surface = revolution(theta(x));
        for (Index i = 0; i < points.cols(); ++i) {
            if (jacobian == nullptr) {
                const double d = distance(surface, points.col(i));
                residuals[i] = weight[i] * (std::isnan(d) ? kFar : d);
                continue;
            }
            RevolutionDistance d = distance_and_slopes(surface, points.col(i));
            if (std::isnan(d.value)) d = {kFar, Eigen::Vector3d::Zero(), RevolutionParameters::Zero()};
            if (family == RoundFamily::sphere) d.by_theta[kAround] += d.by_theta[kAlong];
            residuals[i] = weight[i] * d.value;
            double* slope = jacobian + i;
            for (const int k : free) {
                *slope = weight[i] * d.by_theta[k];
                slope += points.cols();
            }
        }
    }
};

} // namespace

int parameters(RoundFamily family, bool given_direction)
{
    return static_cast<int>(free_parameters(family, given_direction).size());
}

RoundSolution solve(RoundFamily family, const RoundProblem& problem, double around, double along)
{
    Distances distances{family, free_parameters(family, problem.given_direction), {}, {}};
    distances.points = problem.frame.axes.transpose() * (problem.touches.colwise() - problem.frame.point);
    const double extent = distances.points.cwiseAbs().maxCoeff();
    distances.points /= extent;
    distances.weight = problem.weight * extent;
    RevolutionParameters start = RevolutionParameters::Zero();
    start[kAround] = around * extent;
    start[kAlong] = along * extent;

    const Residuals residuals{static_cast<int>(distances.points.cols()), static_cast<int>(distances.free.size()),
                              std::cref(distances)};
    const Minimum minimum = least_squares(residuals, start(distances.free));

    RoundSolution solution;
    solution.theta = distances.theta(minimum.x.data());
    solution.theta[kOffset] *= extent;
    solution.theta[kAround] /= extent;
    solution.theta[kAlong] /= extent;
    solution.cost = minimum.x.allFinite() ? minimum.cost : std::numeric_limits<double>::infinity();
    solution.converged = minimum.converged;
    solution.iterations = minimum.iterations;
    return solution;
}

Shape round_shape(RoundFamily family, const RoundFrame& frame, const VectorXd& theta)
{
    const Eigen::Vector3d a = Eigen::Vector3d(1, theta[kTurn], -theta[kTiltAlong]).normalized();
    const Eigen::Vector3d up(0, theta[kTiltAcross], 1);
    const Eigen::Vector3d n = (up - up.dot(a) * a).normalized();
    const Eigen::Vector3d point = frame.point + theta[kOffset] * frame.axes.col(2);
    const Eigen::Vector3d normal = frame.axes * n, axis = frame.axes * a;
    switch (family) {
    case RoundFamily::sphere:
        return Sphere{point, normal, theta[kAround]};
    case RoundFamily::cylinder:
        return Cylinder{point, normal, axis, theta[kAround]};
    case RoundFamily::cone:
        return Cone{point, normal, axis, theta[kAround], theta[kLean]};
    default:
        return Torus{point, normal, axis, theta[kAround], theta[kLean], theta[kAlong]};
    }
}

} // namespace fettle
