#include "fit/family_solution.h"

#include "core/decompositions.h"
#include "fit/quadric_family.h"
#include "fit/round_start.h"
#include "geometry/bounding_box.h"
#include "surface/revolution.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
// --- families whose height is linear in θ ----------------------------------------------------------------------------

std::optional<VectorXd> linear_fit(const MatrixXd& gradients, const VectorXd& z, const TouchIndices& kept)
{
    const MatrixXd A = gradients(Eigen::all, kept).transpose();
    const VectorXd size = A.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const core::LeastSquaresSolution scaled =
        core::least_squares_by_qr(A * size.cwiseInverse().asDiagonal(), z(kept), kSolutionRankThreshold);
    if (scaled.rank < A.cols()) return std::nullopt;
    return scaled.x.cwiseQuotient(size);
}

/// The zero polynomial in coordinates centred and scaled to the touches.
surface::Polynomial centred_polynomial(const Eigen::Matrix3Xd& touches, int degree)
{
    surface::Polynomial polynomial;
    const Eigen::AlignedBox2d box = geometry::bounding_box(touches.topRows<2>());
    polynomial.origin = box.center();
    polynomial.scale = std::max(box.sizes().maxCoeff() / 2, std::numeric_limits<double>::min());
    polynomial.coefficients = VectorXd::Zero(surface::monomial_count(degree));
    return polynomial;
}

std::optional<surface::Polynomial> fit_polynomial(const TouchSet& touches, const TouchIndices& kept, int degree)
{
    surface::Polynomial polynomial = centred_polynomial(touches.xyz, degree);
    const MatrixXd gradients = surface::height_gradients(polynomial, touches.xyz.topRows(2));
    const std::optional<VectorXd> theta = linear_fit(gradients, touches.xyz.row(2).transpose(), kept);
    if (!theta) return std::nullopt;
    polynomial.coefficients = *theta;
    return polynomial;
}

template <int kDegree>
std::optional<FamilySolution> polynomial(const TouchSet& touches, const TouchIndices& kept,
                                         const std::vector<RoundMinimum>&)
{
    const std::optional<surface::Polynomial> fitted = fit_polynomial(touches, kept, kDegree);
    if (!fitted) return std::nullopt;
    return FamilySolution{*fitted, surface::height_gradients(*fitted, touches.xyz.topRows(2)), {}, true, 1};
}

std::optional<FamilySolution> quadric(const TouchSet& touches, const TouchIndices& kept,
                                      const std::vector<RoundMinimum>&)
{
    const std::optional<surface::Polynomial> paraboloid = fit_polynomial(touches, kept, 2);
    return paraboloid ? solve_quadric(touches, kept, *paraboloid) : std::nullopt;
}

std::optional<FamilySolution> ellipsoid(const TouchSet& touches, const TouchIndices& kept,
                                        const std::vector<RoundMinimum>&)
{
    const std::optional<surface::Polynomial> paraboloid = fit_polynomial(touches, kept, 2);
    return paraboloid ? solve_ellipsoid(touches, kept, *paraboloid) : std::nullopt;
}

std::optional<FamilySolution> plane(const TouchSet& touches, const TouchIndices& kept, const std::vector<RoundMinimum>&)
{
    const std::optional<surface::Polynomial> fitted = fit_polynomial(touches, kept, 1);
    if (!fitted) return std::nullopt;
    const surface::Plane plane{fitted->origin, fitted->coefficients[0], fitted->coefficients.tail<2>() / fitted->scale};
    return FamilySolution{plane, surface::height_gradients(plane, touches.xyz.topRows(2)), {}, true, 1};
}

// --- round families --------------------------------------------------------------------------------------------------

struct Attempt {
    RoundProblem problem;
    RoundSolution solution;
};

/// True if χ² is consistent with the touches' noise. Never true for few touches, which several surfaces may fit.
bool fits_to_noise(const Attempt& attempt, int parameters)
{
    constexpr double kMaxExcessSigmas = 2; // of χ² above its mean
    const double freedom = attempt.problem.touches.cols() - parameters;
    return freedom >= parameters && 2 * attempt.solution.cost <= freedom + kMaxExcessSigmas * std::sqrt(2 * freedom);
}

/// Changes of a cylinder's parameters that keep the direction of its axis in x-y. Tilting it along the axis also turns
/// it, unless its normal has no component across.
MatrixXd directions_keeping_heading(const surface::Cylinder& cylinder)
{
    const Eigen::Vector3d across = Eigen::Vector3d(-cylinder.axis.y(), cylinder.axis.x(), 0);
    MatrixXd free = MatrixXd::Zero(5, 4);
    free(0, 0) = free(1, 1) = free(2, 2) = free(4, 3) = 1;
    free(3, 2) = -cylinder.normal.dot(across) / cylinder.axis.cross(cylinder.normal).dot(across);
    return free;
}

/// True if the normal points up and all touches lie on one side of the axis of revolution, at similar distances from
/// it. Cones with their apex among the touches, and narrow tori or tori with a pole there, easily fit a few touches but
/// do not occur as castings.
bool is_plausible(const surface::Shape& shape, const Eigen::Matrix3Xd& touches)
{
    constexpr double kMaxDistanceRatio = 3; // to the distance of the frame's origin; its inverse is the minimum
    const auto is_plausible_round = [&](const auto& round) {
        if constexpr (requires { round.normal; })
            if (!(round.normal.z() > 0)) return false;
        if constexpr (requires { round.lean; }) {
            const Eigen::Vector3d w = std::sin(round.lean) * round.normal + std::cos(round.lean) * round.axis;
            const Eigen::Vector3d away = std::cos(round.lean) * round.normal - std::sin(round.lean) * round.axis;
            for (const Eigen::Vector3d& touch : touches.colwise()) {
                const Eigen::Vector3d from_axis = round.curvature_around * (touch - round.point) + away;
                const double ratio = (from_axis - from_axis.dot(w) * w).norm();
                if (!(from_axis.dot(away) > 1 / kMaxDistanceRatio && ratio < kMaxDistanceRatio)) return false;
            }
        }
        return true;
    };
    return std::visit(is_plausible_round, shape);
}

Attempt attempt(RoundFamily family, const RoundProblem& problem, double angle, const VectorXd& start)
{
    Attempt result{problem, {}};
    result.problem.frame = rotated(problem.frame, angle);
    result.solution = solve_round(family, result.problem, start);
    return result;
}

/// Solutions that start at the curvatures of the quadratic, in several frames.
std::vector<Attempt> attempts_from_quadratic(RoundFamily family, const RoundStart& start)
{
    constexpr double kQuarterTurn = std::numbers::pi / 2;
    const bool given_direction = start.problem.given_direction;
    std::vector<Attempt> all;
    const auto try_start = [&](double angle, double around, double along) {
        VectorXd theta = surface::RevolutionParameters::Zero();
        theta[surface::kCurvatureAround] = around;
        theta[surface::kCurvatureAlong] = along;
        all.push_back(attempt(family, start.problem, angle, theta));
    };
    if (family == RoundFamily::sphere) {
        const double mean = (start.min_curvature + start.max_curvature) / 2;
        try_start(0, mean, mean);
        return all;
    }
    const double along = family == RoundFamily::torus ? start.min_curvature : 0;
    const double across = family == RoundFamily::torus ? start.max_curvature : 0;
    try_start(0, start.max_curvature, along);
    // A solution with straight rulings that fits is unique; tori are curved both ways and may have two minima.
    const bool found =
        family != RoundFamily::torus && fits_to_noise(all.front(), parameter_count(family, given_direction));
    if (given_direction || found) return all;
    try_start(kQuarterTurn, start.min_curvature, across);
    if (start.is_determined) return all;
    for (const double angle : {kQuarterTurn / 2, 1.5 * kQuarterTurn}) try_start(angle, start.max_curvature, along);
    return all;
}

/// Solutions that start at minima for almost the same touches.
std::vector<Attempt> attempts_from_minima(RoundFamily family, const RoundProblem& problem,
                                          const std::vector<RoundMinimum>& minima)
{
    std::vector<Attempt> all;
    for (const RoundMinimum& minimum : minima) {
        const Eigen::Vector3d axis = problem.frame.axes.transpose() * minimum.first_axis;
        const double angle = problem.given_direction ? 0 : std::atan2(axis.y(), axis.x());
        all.push_back(attempt(family, problem, angle, minimum.theta));
    }
    return all;
}

/// The local minima that may become the global one if a touch is added or left out, and `best`.
std::vector<RoundMinimum> competing_minima(const std::vector<Attempt>& attempts, const Attempt& best)
{
    constexpr double kMaxCostRatio = 2;        // to the global one: one touch seldom compensates more
    constexpr double kMinCostRatio = 1 + 1e-6; // below it two minima are one: the solver's tolerance is smaller
    std::vector<RoundMinimum> minima;
    for (const Attempt& one : attempts) {
        const double ratio = one.solution.cost / best.solution.cost;
        const bool competes = one.solution.converged && ratio > kMinCostRatio && ratio < kMaxCostRatio;
        if (&one == &best || competes) minima.push_back({one.problem.frame.axes.col(0), one.solution.theta});
    }
    return minima;
}

template <RoundFamily kFamily>
std::optional<FamilySolution> round(const TouchSet& touches, const TouchIndices& kept,
                                    const std::vector<RoundMinimum>& near)
{
    if (static_cast<int>(kept.size()) < parameter_count(kFamily, touches.given_direction)) return std::nullopt;
    const RoundStart start = round_start(touches, kept, centred_polynomial(touches.xyz(Eigen::all, kept), 2));
    std::vector<Attempt> attempts =
        near.empty() ? attempts_from_quadratic(kFamily, start) : attempts_from_minima(kFamily, start.problem, near);
    const auto best = std::min_element(attempts.begin(), attempts.end(), [](const Attempt& a, const Attempt& b) {
        return a.solution.cost < b.solution.cost;
    });
    if (!std::isfinite(best->solution.cost)) return std::nullopt;
    FamilySolution result;
    result.minima = competing_minima(attempts, *best);
    refine_round(kFamily, best->problem, best->solution);
    result.shape = round_shape(kFamily, best->problem.frame, best->solution.theta);
    if (!is_plausible(result.shape, touches.xyz)) return std::nullopt;
    result.gradients = surface::height_gradients(result.shape, touches.xyz.topRows(2));
    if (const surface::Cylinder* cylinder = std::get_if<surface::Cylinder>(&result.shape);
        cylinder != nullptr && touches.given_direction)
        result.free_directions = directions_keeping_heading(*cylinder);
    result.converged = best->solution.converged;
    for (const Attempt& one : attempts) result.iterations += one.solution.iterations;
    return result;
}

// --- straight swept surfaces (Wang 2007, 4.4.2 and 4.4.4): a cubic section carried along the rulings -----------------

std::optional<FamilySolution> swept(const TouchSet& touches, const TouchIndices& kept, const std::vector<RoundMinimum>&)
{
    surface::Swept swept;
    swept.ruling = {std::cos(touches.direction), std::sin(touches.direction)};
    const Eigen::Vector2d across(-swept.ruling.y(), swept.ruling.x());
    const VectorXd s = touches.xyz.topRows(2).transpose() * across;
    const VectorXd t = touches.xyz.topRows(2).transpose() * swept.ruling;
    swept.origin = (s.maxCoeff() + s.minCoeff()) / 2 * across + t.mean() * swept.ruling;
    swept.section_max = (s.maxCoeff() - s.minCoeff()) / 2;
    swept.section_min = -swept.section_max;
    if (swept.section_max > 0) swept.scale = swept.section_max;
    MatrixXd gradients = surface::height_gradients(swept, touches.xyz.topRows(2));
    const std::optional<VectorXd> theta = linear_fit(gradients, touches.xyz.row(2).transpose(), kept);
    if (!theta) return std::nullopt;
    swept.section = theta->head<4>();
    swept.slope = (*theta)[4];
    return FamilySolution{swept, std::move(gradients), {}, true, 1};
}

} // namespace

const std::vector<std::string>& family_names()
{
    static const std::vector<std::string> names = {"plane",   "sphere",    "cylinder", "cone",    "torus", "ellipsoid",
                                                   "quadric", "quadratic", "cubic",    "quartic", "swept"};
    return names;
}

std::optional<FamilySolution> solve_family(const std::string& name, const TouchSet& touches, const TouchIndices& kept,
                                           const std::vector<RoundMinimum>& near)
{
    using Solver =
        std::optional<FamilySolution> (*)(const TouchSet&, const TouchIndices&, const std::vector<RoundMinimum>&);
    static const std::map<std::string, Solver> solvers = {
        {"plane", plane},
        {"sphere", round<RoundFamily::sphere>},
        {"cylinder", round<RoundFamily::cylinder>},
        {"cone", round<RoundFamily::cone>},
        {"torus", round<RoundFamily::torus>},
        {"ellipsoid", ellipsoid},
        {"quadric", quadric},
        {"quadratic", polynomial<2>},
        {"cubic", polynomial<3>},
        {"quartic", polynomial<4>},
        {"swept", swept},
    };
    return solvers.at(name)(touches, kept, near);
}

} // namespace fettle::fit
