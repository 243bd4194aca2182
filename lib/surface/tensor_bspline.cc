#include "surface/tensor_bspline.h"

#include "core/constants.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "job/job.h"
#include "surface/basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fettle::surface {

namespace {

constexpr Eigen::Index kMinPoints = 4, kMaxPoints = 2000;
constexpr Eigen::Index kDegree = 3;
// Coordinates closer than this, relative to the extent, share one parameter: files are in single precision.
constexpr double kDuplicateCoordinateTolerance = 1e-4;
// Points with a smaller ratio of width to length are collinear.
constexpr double kMinWidthPerLength = 1e-6;
// Weight of the energy relative to the equations, both scaled to the same trace, and number of iterations in which the
// residual is fitted again (iterated regularisation): parameters that the points determine better than the weight
// converge to least squares.
constexpr double kEnergyWeight = 1e-4;
constexpr int kIterations = 10;
// Relative to the domain: rounding must not place a point on the rectangle's edge outside.
constexpr double kEdgeTolerance = 1e-9;

Eigen::Index degree_of(const Eigen::VectorXd& knots, Eigen::Index control) { return knots.size() - control - 1; }

/// The coordinates in ascending order without duplicates.
std::vector<double> distinct(const Eigen::VectorXd& coordinates)
{
    std::vector<double> sorted(coordinates.begin(), coordinates.end());
    std::ranges::sort(sorted);
    const double tolerance = kDuplicateCoordinateTolerance * (sorted.back() - sorted.front());
    std::vector<double> result = {sorted.front()};
    for (const double coordinate : sorted)
        if (coordinate - result.back() > tolerance) result.push_back(coordinate);
    result.back() = sorted.back();
    return result;
}

/// Numbers of control heights along u and v: at most `points` in all, and in each direction at most max_u and max_v.
/// @param ratio  of the sides of the points' rectangle, u to v
std::array<Eigen::Index, 2> control_counts(Eigen::Index points, double ratio, Eigen::Index max_u, Eigen::Index max_v)
{
    const Eigen::Index desired = std::lround(std::sqrt(static_cast<double>(points) * ratio));
    const Eigen::Index u = std::clamp<Eigen::Index>(desired, 2, std::min(max_u, points / 2));
    const Eigen::Index v = std::min(points / u, max_v);
    return {std::min(points / v, max_u), v};
}

/// Knots by averaging (Piegl and Tiller 1997, eq. 9.8): one parameter per control height, interpolated at even ranks of
/// the coordinates. These are distinct, so all interior knots are simple.
Eigen::VectorXd averaged_knots(const std::vector<double>& coordinates, Eigen::Index control)
{
    const Eigen::Index degree = std::min(kDegree, control - 1);
    Eigen::VectorXd parameters(control);
    for (Eigen::Index i = 0; i < control; ++i) {
        const double rank = double(i) * double(coordinates.size() - 1) / double(control - 1);
        const auto below = std::min(static_cast<std::size_t>(rank), coordinates.size() - 2);
        parameters[i] = std::lerp(coordinates[below], coordinates[below + 1], rank - double(below));
    }
    Eigen::VectorXd knots(control + degree + 1);
    knots.head(degree + 1).setConstant(coordinates.front());
    knots.tail(degree + 1).setConstant(coordinates.back());
    for (Eigen::Index j = 1; j < control - degree; ++j) knots[j + degree] = parameters.segment(j, degree).mean();
    return knots;
}

/// Gram matrix of the derivatives of that order, by Gauss quadrature with four points per span: exact for cubics.
Eigen::MatrixXd gram(const Eigen::VectorXd& knots, Eigen::Index control, int order)
{
    constexpr std::array<double, 2> kNodes = {0.339981043584856, 0.861136311594053};
    constexpr std::array<double, 2> kWeights = {0.652145154862546, 0.347854845137454};
    const int degree = degree_of(knots, control);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(control, control);
    for (Eigen::Index s = degree; s < control; ++s) {
        const double half = (knots[s + 1] - knots[s]) / 2;
        for (const double side : {-1.0, 1.0})
            for (std::size_t k = 0; k < 2; ++k) {
                const double t = knots[s] + half * (1 + side * kNodes[k]);
                const Eigen::VectorXd f = basis_derivative(knots, degree, t, order);
                result.block(s - degree, s - degree, degree + 1, degree + 1) += kWeights[k] * half * f * f.transpose();
            }
    }
    return result;
}

/// Adds factor · (v ⊗ u), whose factors have the bandwidth of cubics.
void add_kronecker_product(std::vector<Eigen::Triplet<double>>& entries, const Eigen::MatrixXd& u,
                           const Eigen::MatrixXd& v, double factor)
{
    for (Eigen::Index j = 0; j < v.cols(); ++j)
        for (Eigen::Index l = 0; l < v.cols(); ++l)
            for (Eigen::Index i = 0; i < u.cols(); ++i)
                for (Eigen::Index k = std::max<Eigen::Index>(0, i - kDegree);
                     k <= std::min(u.cols() - 1, i + kDegree) && std::abs(j - l) <= kDegree; ++k)
                    entries.emplace_back(i + u.cols() * j, k + u.cols() * l, factor * u(i, k) * v(j, l));
}

Eigen::SparseMatrix<double> bending_energy(const TensorBspline& bspline)
{
    const Eigen::Index n_u = bspline.heights.rows(), n_v = bspline.heights.cols();
    std::vector<Eigen::Triplet<double>> entries;
    for (int order = 0; order <= 2; ++order)
        add_kronecker_product(entries, gram(bspline.knots_u, n_u, order), gram(bspline.knots_v, n_v, 2 - order),
                              order == 1 ? 2 : 1);
    Eigen::SparseMatrix<double> energy(n_u * n_v, n_u * n_v);
    energy.setFromTriplets(entries.begin(), entries.end());
    return energy;
}

struct Weights {
    BasisFunctions u, v;
    Eigen::Matrix2d rotation; ///< from M to u, v
};

/// The basis functions at a point of M; nothing outside the rectangle.
std::optional<Weights> weights(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const Eigen::Matrix2d rotation = job::rotation_working_machine(bspline.angle);
    const Eigen::Vector2d uv = rotation * xy;
    const auto along = [](const Eigen::VectorXd& knots, Eigen::Index control,
                          double t) -> std::optional<BasisFunctions> {
        const double first = knots[0], last = knots[knots.size() - 1], edge = kEdgeTolerance * (last - first);
        if (!(t >= first - edge && t <= last + edge)) return {};
        return basis_functions(knots, degree_of(knots, control), std::clamp(t, first, last));
    };
    std::optional<BasisFunctions> u = along(bspline.knots_u, bspline.heights.rows(), uv.x());
    std::optional<BasisFunctions> v = along(bspline.knots_v, bspline.heights.cols(), uv.y());
    if (!u || !v) return {};
    return Weights{std::move(*u), std::move(*v), rotation};
}

/// The control heights of the basis functions.
auto heights_at(const TensorBspline& bspline, const Weights& w)
{
    return bspline.heights.block(w.u.first, w.v.first, w.u.value.size(), w.v.value.size());
}

void check_not_collinear(const Eigen::Matrix2Xd& xy)
{
    if (!xy.allFinite()) throw core::InputError("a point is not finite");
    const Eigen::Matrix2Xd centred = xy.colwise() - xy.rowwise().mean();
    const Eigen::Vector2d spread = core::symmetric_eigen<2>(centred * centred.transpose()).values;
    if (spread[0] <= kMinWidthPerLength * kMinWidthPerLength * spread[1])
        throw core::InputError("touches lie on one line in x and y");
}

Eigen::Index count_distinct(const Eigen::Matrix2Xd& uv)
{
    std::vector<std::array<double, 2>> points;
    for (Eigen::Index i = 0; i < uv.cols(); ++i) points.push_back({uv(0, i), uv(1, i)});
    std::ranges::sort(points);
    return std::unique(points.begin(), points.end()) - points.begin();
}

} // namespace

TensorBsplineSystem::TensorBsplineSystem(const Eigen::Matrix2Xd& xy, double angle)
{
    if (xy.cols() > 0) check_not_collinear(xy);
    const Eigen::Matrix2Xd uv = job::rotation_working_machine(angle) * xy;
    const Eigen::Index count = count_distinct(uv);
    if (count < kMinPoints || count > kMaxPoints)
        throw core::InputError("the B-spline takes from " + std::to_string(kMinPoints) + " to " +
                               std::to_string(kMaxPoints) + " different points, got " + std::to_string(count));
    const std::vector<double> along_u = distinct(uv.row(0)), along_v = distinct(uv.row(1));
    const double ratio = (along_u.back() - along_u.front()) / (along_v.back() - along_v.front());
    const auto [n_u, n_v] = control_counts(count, ratio, along_u.size(), along_v.size());
    zero_surface_ = {angle, averaged_knots(along_u, n_u), averaged_knots(along_v, n_v),
                     Eigen::MatrixXd::Zero(n_u, n_v)};

    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < xy.cols(); ++i) {
        const Weights w = *weights(zero_surface_, xy.col(i));
        for (Eigen::Index b = 0; b < w.v.value.size(); ++b)
            for (Eigen::Index a = 0; a < w.u.value.size(); ++a)
                entries.emplace_back(i, w.u.first + a + n_u * (w.v.first + b), w.u.value[a] * w.v.value[b]);
    }
    equations_.resize(xy.cols(), n_u * n_v);
    equations_.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseMatrix<double> normal = equations_.transpose() * equations_;
    const Eigen::SparseMatrix<double> energy = bending_energy(zero_surface_);
    normal += kEnergyWeight * normal.diagonal().sum() / energy.diagonal().sum() * energy;
    factor_.compute(normal);
}

Eigen::MatrixXd TensorBsplineSystem::control_heights(const Eigen::MatrixXd& z) const
{
    Eigen::MatrixXd heights = Eigen::MatrixXd::Zero(equations_.cols(), z.cols());
    for (int i = 0; i < kIterations; ++i) heights += factor_.solve(equations_.transpose() * (z - equations_ * heights));
    return heights;
}

TensorBspline TensorBsplineSystem::surface(const Eigen::VectorXd& z) const
{
    TensorBspline result = zero_surface_;
    result.heights = control_heights(z).reshaped(zero_surface_.heights.rows(), zero_surface_.heights.cols());
    return result;
}

std::string knot_problem(const Eigen::VectorXd& knots, Eigen::Index control)
{
    const Eigen::Index degree = degree_of(knots, control);
    if (degree < 1 || degree > kDegree || control <= degree)
        return "there are " + std::to_string(knots.size()) + " for " + std::to_string(control) +
               " control heights, which does not give a degree from 1 to " + std::to_string(kDegree);
    for (Eigen::Index i = 1; i < knots.size(); ++i) {
        const bool end_knot = i <= degree || i >= control + 1;
        if (end_knot ? knots[i] != knots[i - 1] : knots[i] <= knots[i - 1])
            return "must ascend, the first and the last " + std::to_string(degree + 1) + " the same";
    }
    return {};
}

double height(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<Weights> w = weights(bspline, xy);
    if (!w) return core::kNaN;
    return w->u.value.dot(heights_at(bspline, *w) * w->v.value);
}

Eigen::Vector2d slope(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<Weights> w = weights(bspline, xy);
    if (!w) return Eigen::Vector2d::Constant(core::kNaN);
    const auto net = heights_at(bspline, *w);
    return w->rotation.transpose() *
           Eigen::Vector2d(w->u.derivative.dot(net * w->v.value), w->u.value.dot(net * w->v.derivative));
}

Eigen::VectorXd height_gradient(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<Weights> w = weights(bspline, xy);
    if (!w) return Eigen::VectorXd::Constant(bspline.heights.size(), core::kNaN);
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(bspline.heights.rows(), bspline.heights.cols());
    gradient.block(w->u.first, w->v.first, w->u.value.size(), w->v.value.size()) = w->u.value * w->v.value.transpose();
    return gradient.reshaped();
}

} // namespace fettle::surface
