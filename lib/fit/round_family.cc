#include "fit/round_family.h"

#include "fit/tiny_least_squares.h"
#include "surface/revolution.h"

#include <cmath>
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

/// Residuals for ceres::TinySolver, in units of the touches' extent.
template <int P>
struct Distances {
    using Scalar = double;
    enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = P };

    RoundFamily family;
    std::vector<int> free;
    RevolutionParameters fixed;
    Matrix3Xd points; ///< in the frame
    VectorXd weight;

    int NumResiduals() const { return static_cast<int>(points.cols()); }

    bool operator()(const double* x, double* residuals, double* jacobian) const
    {
        // Beyond the centre there is no distance: so bad that the step is taken back.
        constexpr double kFar = 1e6;
        RevolutionParameters theta = fixed;
        for (int k = 0; k < P; ++k) theta[free[static_cast<std::size_t>(k)]] = x[k];
        close(family, theta);
        const Revolution surface = revolution(theta);
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
            for (int k = 0; k < P; ++k)
                jacobian[k * points.cols() + i] = weight[i] * d.by_theta[free[static_cast<std::size_t>(k)]];
        }
        return true;
    }
};

template <int P>
RoundSolution solve_with(RoundFamily family, const RoundProblem& problem, double around, double along)
{
    Distances<P> function;
    function.points = problem.frame.axes.transpose() * (problem.touches.colwise() - problem.frame.point);
    const double extent = function.points.cwiseAbs().maxCoeff();
    function.points /= extent;
    function.weight = problem.weight * extent;
    function.family = family;
    function.free = free_parameters(family, problem.given_direction);
    function.fixed = RevolutionParameters::Zero();
    RevolutionParameters start = RevolutionParameters::Zero();
    start[kAround] = around * extent;
    start[kAlong] = along * extent;

    Eigen::Matrix<double, P, 1> x;
    for (int k = 0; k < P; ++k) x[k] = start[function.free[static_cast<std::size_t>(k)]];
    const Minimum<P> minimum = least_squares(function, x);

    RevolutionParameters end = RevolutionParameters::Zero();
    for (int k = 0; k < P; ++k) end[function.free[static_cast<std::size_t>(k)]] = minimum.x[k];
    close(family, end);
    RoundSolution solution;
    end[kOffset] *= extent;
    end[kAround] /= extent;
    end[kAlong] /= extent;
    solution.theta = end;
    solution.cost = minimum.x.allFinite() ? minimum.cost : std::numeric_limits<double>::infinity();
    solution.converged = minimum.converged;
    solution.iterations = minimum.iterations;
    return solution;
}

} // namespace

int parameters(RoundFamily family, bool given_direction)
{
    return static_cast<int>(free_parameters(family, given_direction).size());
}

RoundSolution solve(RoundFamily family, const RoundProblem& problem, double around, double along)
{
    switch (parameters(family, problem.given_direction)) {
    case 4:
        return solve_with<4>(family, problem, around, along);
    case 5:
        return solve_with<5>(family, problem, around, along);
    case 6:
        return solve_with<6>(family, problem, around, along);
    default:
        return solve_with<7>(family, problem, around, along);
    }
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
