#include "fit/family_solution.h"

#include "core/decompositions.h"
#include "fit/quadric_family.h"
#include "fit/round_family.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
// Of designs with columns of unit length; touches in F4 are rounded by 6e-8 of their size.
constexpr double kRankThreshold = 1e-5;

// --- families whose height is linear in θ ----------------------------------------------------------------------------

std::optional<VectorXd> linear_fit(const MatrixXd& gradients, const VectorXd& z, const Columns& kept)
{
    const MatrixXd A = gradients(Eigen::all, kept).transpose();
    const VectorXd size = A.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const LeastSquares scaled = least_squares_by_qr(A * size.cwiseInverse().asDiagonal(), z(kept), kRankThreshold);
    if (scaled.rank < A.cols()) return std::nullopt;
    return scaled.x.cwiseQuotient(size);
}

Polynomial about_the_middle(const Eigen::Matrix3Xd& touches, int degree)
{
    Polynomial polynomial;
    const Eigen::Vector2d least = touches.topRows(2).rowwise().minCoeff();
    const Eigen::Vector2d most = touches.topRows(2).rowwise().maxCoeff();
    polynomial.origin = (least + most) / 2;
    polynomial.scale = std::max((most - least).maxCoeff() / 2, std::numeric_limits<double>::min());
    polynomial.coefficients = VectorXd::Zero(monomials(degree));
    return polynomial;
}

std::optional<Polynomial> fit_polynomial(const Touched& touched, const Columns& kept, int degree)
{
    Polynomial polynomial = about_the_middle(touched.xyz, degree);
    const MatrixXd gradients = height_gradients(polynomial, touched.xyz.topRows(2));
    const std::optional<VectorXd> theta = linear_fit(gradients, touched.xyz.row(2).transpose(), kept);
    if (!theta) return std::nullopt;
    polynomial.coefficients = *theta;
    return polynomial;
}

template <int kDegree>
std::optional<FamilySolution> polynomial(const Touched& touched, const Columns& kept)
{
    const std::optional<Polynomial> fitted = fit_polynomial(touched, kept, kDegree);
    if (!fitted) return std::nullopt;
    return FamilySolution{*fitted, height_gradients(*fitted, touched.xyz.topRows(2)), {}, true, 1};
}

std::optional<FamilySolution> quadric(const Touched& touched, const Columns& kept)
{
    const std::optional<Polynomial> paraboloid = fit_polynomial(touched, kept, 2);
    return paraboloid ? solve_quadric(touched, kept, *paraboloid) : std::nullopt;
}

std::optional<FamilySolution> plane(const Touched& touched, const Columns& kept)
{
    const std::optional<Polynomial> fitted = fit_polynomial(touched, kept, 1);
    if (!fitted) return std::nullopt;
    const Plane plane{fitted->origin, fitted->coefficients[0], fitted->coefficients.tail<2>() / fitted->scale};
    return FamilySolution{plane, height_gradients(plane, touched.xyz.topRows(2)), {}, true, 1};
}

// --- round families --------------------------------------------------------------------------------------------------

/// Where to look for round surfaces: the quadratic nearest to the touches.
struct RoundStart {
    RoundProblem problem; ///< first axis along the direction of the least curvature
    double least = 0;     ///< curvatures, > 0 convex, by size
    double most = 0;
    bool known = true; ///< does the quadratic determine the directions?
};

RoundStart round_start(const Touched& touched, const Columns& kept)
{
    const Eigen::Matrix3Xd xyz = touched.xyz(Eigen::all, kept);
    const Polynomial frame = about_the_middle(xyz, 2);
    const MatrixXd A = height_gradients(frame, xyz.topRows(2)).transpose();
    const auto [c, rank] = shortest_least_squares(A, xyz.row(2).transpose(), kRankThreshold);

    RoundStart start;
    start.known = rank == A.cols();
    const Eigen::Vector2d slope = c.segment<2>(1) / frame.scale;
    const Eigen::Vector3d n = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
    Eigen::Matrix3d& axes = start.problem.frame.axes;
    axes.col(2) = n;
    const auto tangent = [&](const Eigen::Vector2d& along) {
        return Eigen::Vector3d(along.x(), along.y(), slope.dot(along)).normalized();
    };
    axes.col(0) = tangent({std::cos(touched.direction), std::sin(touched.direction)});
    // Tilting such a frame along its first axis, across which it lies level, keeps that axis in its vertical plane.
    if (touched.given_direction) axes.col(2) = (Eigen::Vector3d::UnitZ() - axes(2, 0) * axes.col(0)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    start.problem.frame.point << frame.origin, c[0];
    start.problem.given_direction = touched.given_direction;
    start.problem.touches = xyz;

    // Weingarten map of the quadratic in the tangent plane: H in x-y, seen along the tangents.
    Eigen::Matrix2d hessian;
    hessian << 2 * c[3], c[4], c[4], 2 * c[5];
    hessian *= -n.z() / (frame.scale * frame.scale);
    const Eigen::Matrix2d flat = axes.topLeftCorner<2, 2>();
    const Eigen::Matrix2d shape = flat.transpose() * hessian * flat;
    if (touched.given_direction) {
        start.least = shape(0, 0);
        start.most = shape(1, 1);
    } else {
        const SymmetricEigen<2> eigen = symmetric_eigen(shape);
        const int smaller = std::abs(eigen.values[0]) < std::abs(eigen.values[1]) ? 0 : 1;
        start.least = eigen.values[smaller];
        start.most = eigen.values[1 - smaller];
        axes.col(0) = (axes.leftCols<2>() * eigen.vectors.col(smaller)).normalized().eval();
        axes.col(1) = n.cross(axes.col(0));
    }
    // Distance over n_z is the vertical error, to first order.
    start.problem.weight.resize(xyz.cols());
    Polynomial quadratic = frame;
    quadratic.coefficients = c;
    for (Index i = 0; i < xyz.cols(); ++i) {
        const double steepness = fettle::slope(quadratic, xyz.col(i).head<2>()).squaredNorm();
        start.problem.weight[i] = std::sqrt(1 + steepness) / touched.sigma;
    }
    return start;
}

/// The frame turned about its normal.
RoundFrame turned(const RoundFrame& frame, double angle)
{
    RoundFrame result = frame;
    result.axes.col(0) = std::cos(angle) * frame.axes.col(0) + std::sin(angle) * frame.axes.col(1);
    result.axes.col(1) = frame.axes.col(2).cross(result.axes.col(0));
    return result;
}

struct Attempt {
    RoundProblem problem;
    RoundSolution solution;
};

/// As near as touches of their standard deviation come? Few touches may be explained in several ways: never.
bool explains(const Attempt& attempt, int parameters)
{
    constexpr double kSpread = 2; // standard deviations of chi2
    const auto n = static_cast<double>(attempt.problem.touches.cols());
    const double freedom = n - parameters;
    return freedom >= parameters && 2 * attempt.solution.cost <= freedom + kSpread * std::sqrt(2 * freedom);
}

void attempt(RoundFamily family, RoundProblem problem, double angle, double around, double along,
             std::optional<Attempt>& best, int& iterations)
{
    problem.frame = turned(problem.frame, angle);
    RoundSolution solution = solve(family, problem, around, along);
    iterations += solution.iterations;
    if (!std::isfinite(solution.cost) || (best && !(solution.cost < best->solution.cost))) return;
    best = Attempt{std::move(problem), std::move(solution)};
}

/// Changes of a cylinder's parameters that leave the direction of its axis in x-y: tilting it along turns it, too,
/// unless its normal is level across.
MatrixXd along_the_direction(const Cylinder& cylinder)
{
    const Eigen::Vector3d level = Eigen::Vector3d(-cylinder.axis.y(), cylinder.axis.x(), 0);
    MatrixXd free = MatrixXd::Zero(5, 4);
    free(0, 0) = free(1, 1) = free(2, 2) = free(4, 3) = 1;
    free(3, 2) = -cylinder.normal.dot(level) / cylinder.axis.cross(cylinder.normal).dot(level);
    return free;
}

/// Do all touches lie on one side of the axis of revolution, at a distance of one size? Cones whose apex lies among
/// them, and tori as narrow or with a pole there, go through a few touches with ease and are no castings.
bool beside_the_axis(const Shape& shape, const Eigen::Matrix3Xd& touches)
{
    constexpr double kMostChange = 3; // times as far or as near as the frame's point
    const auto beside = [&](const auto& round) {
        const Eigen::Vector3d w = std::sin(round.lean) * round.normal + std::cos(round.lean) * round.axis;
        const Eigen::Vector3d away = std::cos(round.lean) * round.normal - std::sin(round.lean) * round.axis;
        for (const Eigen::Vector3d& touch : touches.colwise()) {
            const Eigen::Vector3d from_axis = round.around * (touch - round.point) + away;
            const double ratio = (from_axis - from_axis.dot(w) * w).norm();
            if (!(from_axis.dot(away) > 1 / kMostChange && ratio < kMostChange)) return false;
        }
        return true;
    };
    if (const Cone* cone = std::get_if<Cone>(&shape)) return beside(*cone);
    if (const Torus* torus = std::get_if<Torus>(&shape)) return beside(*torus);
    return true;
}

template <RoundFamily kFamily>
std::optional<FamilySolution> round(const Touched& touched, const Columns& kept)
{
    constexpr double kQuarter = std::numbers::pi / 2;
    const RoundStart start = round_start(touched, kept);
    const int free = parameters(kFamily, touched.given_direction);
    if (static_cast<int>(kept.size()) < free) return std::nullopt;
    std::optional<Attempt> best;
    int iterations = 0;
    if (kFamily == RoundFamily::sphere) {
        const double mean = (start.least + start.most) / 2;
        attempt(kFamily, start.problem, 0, mean, mean, best, iterations);
    } else {
        const double along = kFamily == RoundFamily::torus ? start.least : 0;
        const double across = kFamily == RoundFamily::torus ? start.most : 0;
        attempt(kFamily, start.problem, 0, start.most, along, best, iterations);
        // A straight ruling that the touches lie along is the only one; tori bend both ways and may have two minima.
        const bool found = kFamily != RoundFamily::torus && best && explains(*best, free);
        if (!touched.given_direction && !found)
            attempt(kFamily, start.problem, kQuarter, start.least, across, best, iterations);
        if (!start.known && !touched.given_direction && !found)
            for (const double angle : {kQuarter / 2, 1.5 * kQuarter})
                attempt(kFamily, start.problem, angle, start.most, along, best, iterations);
    }
    if (!best) return std::nullopt;
    FamilySolution result;
    result.shape = round_shape(kFamily, best->problem.frame, best->solution.theta);
    const bool up = std::visit(
        [](const auto& shape) {
            if constexpr (requires { shape.normal; }) return shape.normal.z() > 0;
            return true;
        },
        result.shape);
    if (!up || !beside_the_axis(result.shape, touched.xyz)) return std::nullopt;
    result.gradients = height_gradients(result.shape, touched.xyz.topRows(2));
    if (const Cylinder* cylinder = std::get_if<Cylinder>(&result.shape); cylinder != nullptr && touched.given_direction)
        result.free = along_the_direction(*cylinder);
    result.converged = best->solution.converged;
    result.iterations = iterations;
    return result;
}

// --- straight swept (Wang 2007, 4.4.2 and 4.4.4): a cubic section carried along the rulings
// ----------------------------

std::optional<FamilySolution> swept(const Touched& touched, const Columns& kept)
{
    Swept swept;
    swept.ruling = {std::cos(touched.direction), std::sin(touched.direction)};
    const Eigen::Vector2d across(-swept.ruling.y(), swept.ruling.x());
    const VectorXd s = touched.xyz.topRows(2).transpose() * across;
    const VectorXd t = touched.xyz.topRows(2).transpose() * swept.ruling;
    swept.origin = (s.maxCoeff() + s.minCoeff()) / 2 * across + t.mean() * swept.ruling;
    swept.section_most = (s.maxCoeff() - s.minCoeff()) / 2;
    swept.section_least = -swept.section_most;
    if (swept.section_most > 0) swept.scale = swept.section_most;
    MatrixXd gradients = height_gradients(swept, touched.xyz.topRows(2));
    const std::optional<VectorXd> theta = linear_fit(gradients, touched.xyz.row(2).transpose(), kept);
    if (!theta) return std::nullopt;
    swept.section = theta->head<4>();
    swept.slope = (*theta)[4];
    return FamilySolution{swept, std::move(gradients), {}, true, 1};
}

using Solver = std::optional<FamilySolution> (*)(const Touched&, const Columns& kept);

const std::map<std::string, Solver>& families()
{
    static const std::map<std::string, Solver> table = {
        {"plane", plane},
        {"sphere", round<RoundFamily::sphere>},
        {"cylinder", round<RoundFamily::cylinder>},
        {"cone", round<RoundFamily::cone>},
        {"torus", round<RoundFamily::torus>},
        {"quadric", quadric},
        {"quadratic", polynomial<2>},
        {"cubic", polynomial<3>},
        {"quartic", polynomial<4>},
        {"swept", swept},
    };
    return table;
}

} // namespace

const std::vector<std::string>& family_names()
{
    static const std::vector<std::string> names = {"plane",   "sphere",    "cylinder", "cone",    "torus",
                                                   "quadric", "quadratic", "cubic",    "quartic", "swept"};
    return names;
}

std::optional<FamilySolution> solve_family(const std::string& name, const Touched& touched, const Columns& kept)
{
    return families().at(name)(touched, kept);
}

} // namespace fettle
