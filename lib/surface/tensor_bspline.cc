#include "surface/tensor_bspline.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "job/job.h"
#include "surface/basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle {

namespace {

constexpr Eigen::Index kLeastPoints = 4, kMostPoints = 2000;
constexpr Eigen::Index kDegree = 3;
// Places nearer to each other than this, relative to the extent, carry one parameter: files are in single precision.
constexpr double kSamePlace = 1e-4;
// Width over length of points that lie on a line.
constexpr double kOnALine = 1e-6;
// Of the energy against the equations, both scaled to the same trace, and how often the remainder is fitted again
// (iterated regularisation): directions that the points determine better than the weight converge to least squares.
constexpr double kEnergyWeight = 1e-4;
constexpr int kIterations = 10;
constexpr double kEdge = 1e-9; // of the domain: rounding of a point on the rectangle's edge does not put it outside

Eigen::Index degree_of(const Eigen::VectorXd& knots, Eigen::Index control) { return knots.size() - control - 1; }

/// Ascending, those that are the same counted once.
std::vector<double> distinct(const Eigen::VectorXd& places)
{
    std::vector<double> sorted(places.begin(), places.end());
    std::ranges::sort(sorted);
    const double same = kSamePlace * (sorted.back() - sorted.front());
    std::vector<double> result = {sorted.front()};
    for (const double place : sorted)
        if (place - result.back() > same) result.push_back(place);
    result.back() = sorted.back();
    return result;
}

/// How many control heights along u and v: no more than `points` in all and than there are places along either.
std::array<Eigen::Index, 2> control_counts(Eigen::Index points, double ratio, Eigen::Index along_u,
                                           Eigen::Index along_v)
{
    const auto wanted = static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(points) * ratio)));
    const Eigen::Index u = std::clamp<Eigen::Index>(wanted, 2, std::min(along_u, points / 2));
    const Eigen::Index v = std::min(points / u, along_v);
    return {std::min(points / v, along_u), v};
}

/// As many parameters as control heights, evenly ranked among the places, and knots that are averages of neighbouring
/// ones (Piegl and Tiller 1997, eq. 9.8). The places differ, so every knot inside is simple.
Eigen::VectorXd averaged_knots(const std::vector<double>& places, Eigen::Index control)
{
    const Eigen::Index degree = std::min(kDegree, control - 1);
    Eigen::VectorXd parameters(control);
    for (Eigen::Index i = 0; i < control; ++i) {
        const double rank =
            static_cast<double>(i) * static_cast<double>(places.size() - 1) / static_cast<double>(control - 1);
        const auto below = std::min(static_cast<std::size_t>(rank), places.size() - 2);
        parameters[i] = std::lerp(places[below], places[below + 1], rank - static_cast<double>(below));
    }
    Eigen::VectorXd knots(control + degree + 1);
    knots.head(degree + 1).setConstant(places.front());
    knots.tail(degree + 1).setConstant(places.back());
    for (Eigen::Index j = 1; j < control - degree; ++j) knots[j + degree] = parameters.segment(j, degree).mean();
    return knots;
}

/// ∫ of the products of the order-th derivatives, by Gauss's rule of four points: exact for cubics.
Eigen::MatrixXd products(const Eigen::VectorXd& knots, Eigen::Index control, int order)
{
    constexpr std::array<double, 2> kPlaces = {0.339981043584856, 0.861136311594053};
    constexpr std::array<double, 2> kWeights = {0.652145154862546, 0.347854845137454};
    const auto degree = static_cast<int>(degree_of(knots, control));
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(control, control);
    for (Eigen::Index s = degree; s < control; ++s) {
        const double half = (knots[s + 1] - knots[s]) / 2;
        for (const double side : {-1.0, 1.0})
            for (std::size_t k = 0; k < 2; ++k) {
                const double t = knots[s] + half * (1 + side * kPlaces[k]);
                const Eigen::VectorXd f = basis_derivative(knots, degree, t, order);
                result.block(s - degree, s - degree, degree + 1, degree + 1) += kWeights[k] * half * f * f.transpose();
            }
    }
    return result;
}

void add_product(std::vector<Eigen::Triplet<double>>& entries, const Eigen::MatrixXd& u, const Eigen::MatrixXd& v,
                 double factor)
{
    for (Eigen::Index j = 0; j < v.cols(); ++j)
        for (Eigen::Index l = 0; l < v.cols(); ++l)
            for (Eigen::Index i = 0; i < u.cols(); ++i)
                for (Eigen::Index k = std::max<Eigen::Index>(0, i - kDegree);
                     k <= std::min(u.cols() - 1, i + kDegree) && std::abs(j - l) <= kDegree; ++k)
                    entries.emplace_back(static_cast<int>(i + u.cols() * j), static_cast<int>(k + u.cols() * l),
                                         factor * u(i, k) * v(j, l));
}

Eigen::SparseMatrix<double> bending_energy(const TensorBspline& bspline)
{
    const Eigen::Index n_u = bspline.heights.rows(), n_v = bspline.heights.cols();
    std::vector<Eigen::Triplet<double>> entries;
    for (int order = 0; order <= 2; ++order)
        add_product(entries, products(bspline.knots_u, n_u, order), products(bspline.knots_v, n_v, 2 - order),
                    order == 1 ? 2 : 1);
    Eigen::SparseMatrix<double> energy(n_u * n_v, n_u * n_v);
    energy.setFromTriplets(entries.begin(), entries.end());
    return energy;
}

struct Weights {
    Basis u, v;
    Eigen::Matrix2d rotation; ///< from M to u, v
};

/// Nothing outside the rectangle.
std::optional<Weights> weights(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const Eigen::Matrix2d rotation = rotation_working_machine(bspline.angle);
    const Eigen::Vector2d uv = rotation * xy;
    const auto along = [](const Eigen::VectorXd& knots, Eigen::Index control, double t) -> std::optional<Basis> {
        const double first = knots[0], last = knots[knots.size() - 1], edge = kEdge * (last - first);
        if (!(t >= first - edge && t <= last + edge)) return {};
        return basis(knots, static_cast<int>(degree_of(knots, control)), std::clamp(t, first, last));
    };
    std::optional<Basis> u = along(bspline.knots_u, bspline.heights.rows(), uv.x());
    std::optional<Basis> v = along(bspline.knots_v, bspline.heights.cols(), uv.y());
    if (!u || !v) return {};
    return Weights{std::move(*u), std::move(*v), rotation};
}

auto heights_at(const TensorBspline& bspline, const Weights& w)
{
    return bspline.heights.block(w.u.first, w.v.first, w.u.value.size(), w.v.value.size());
}

void check_spread(const Eigen::Matrix2Xd& xy)
{
    if (!xy.allFinite()) throw InputError("a point is not finite");
    const Eigen::Matrix2Xd centred = xy.colwise() - xy.rowwise().mean();
    const Eigen::Vector2d spread = symmetric_eigen<2>(centred * centred.transpose()).values;
    if (spread[0] <= kOnALine * kOnALine * spread[1]) throw InputError("touches lie on one line in x and y");
}

Eigen::Index count_places(const Eigen::Matrix2Xd& uv)
{
    std::vector<std::array<double, 2>> places;
    for (Eigen::Index i = 0; i < uv.cols(); ++i) places.push_back({uv(0, i), uv(1, i)});
    std::ranges::sort(places);
    return std::unique(places.begin(), places.end()) - places.begin();
}

} // namespace

TensorBsplineSystem::TensorBsplineSystem(const Eigen::Matrix2Xd& xy, double angle)
{
    if (xy.cols() > 0) check_spread(xy);
    const Eigen::Matrix2Xd uv = rotation_working_machine(angle) * xy;
    const Eigen::Index count = count_places(uv);
    if (count < kLeastPoints || count > kMostPoints)
        throw InputError("the B-spline takes from " + std::to_string(kLeastPoints) + " to " +
                         std::to_string(kMostPoints) + " different points, got " + std::to_string(count));
    const std::vector<double> along_u = distinct(uv.row(0)), along_v = distinct(uv.row(1));
    const double ratio = (along_u.back() - along_u.front()) / (along_v.back() - along_v.front());
    const auto [n_u, n_v] = control_counts(count, ratio, static_cast<Eigen::Index>(along_u.size()),
                                           static_cast<Eigen::Index>(along_v.size()));
    flat_ = {angle, averaged_knots(along_u, n_u), averaged_knots(along_v, n_v), Eigen::MatrixXd::Zero(n_u, n_v)};

    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < xy.cols(); ++i) {
        const Weights w = *weights(flat_, xy.col(i));
        for (Eigen::Index b = 0; b < w.v.value.size(); ++b)
            for (Eigen::Index a = 0; a < w.u.value.size(); ++a)
                entries.emplace_back(static_cast<int>(i), static_cast<int>(w.u.first + a + n_u * (w.v.first + b)),
                                     w.u.value[a] * w.v.value[b]);
    }
    equations_.resize(xy.cols(), n_u * n_v);
    equations_.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseMatrix<double> normal = equations_.transpose() * equations_;
    const Eigen::SparseMatrix<double> energy = bending_energy(flat_);
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
    TensorBspline result = flat_;
    result.heights = control_heights(z).reshaped(flat_.heights.rows(), flat_.heights.cols());
    return result;
}

std::string wrong_with_knots(const Eigen::VectorXd& knots, Eigen::Index control)
{
    const Eigen::Index degree = degree_of(knots, control);
    if (degree < 1 || degree > kDegree || control <= degree)
        return "there are " + std::to_string(knots.size()) + " for " + std::to_string(control) +
               " control heights, which makes no degree from 1 to " + std::to_string(kDegree);
    for (Eigen::Index i = 1; i < knots.size(); ++i) {
        const bool at_an_end = i <= degree || i >= control + 1;
        if (at_an_end ? knots[i] != knots[i - 1] : knots[i] <= knots[i - 1])
            return "must ascend, the first and the last " + std::to_string(degree + 1) + " the same";
    }
    return {};
}

double height(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<Weights> w = weights(bspline, xy);
    if (!w) return std::numeric_limits<double>::quiet_NaN();
    return w->u.value.dot(heights_at(bspline, *w) * w->v.value);
}

Eigen::Vector2d slope(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<Weights> w = weights(bspline, xy);
    if (!w) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    const auto net = heights_at(bspline, *w);
    return w->rotation.transpose() *
           Eigen::Vector2d(w->u.derivative.dot(net * w->v.value), w->u.value.dot(net * w->v.derivative));
}

Eigen::VectorXd height_gradient(const TensorBspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<Weights> w = weights(bspline, xy);
    if (!w) return Eigen::VectorXd::Constant(bspline.heights.size(), std::numeric_limits<double>::quiet_NaN());
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(bspline.heights.rows(), bspline.heights.cols());
    gradient.block(w->u.first, w->v.first, w->u.value.size(), w->v.value.size()) = w->u.value * w->v.value.transpose();
    return gradient.reshaped();
}

Eigen::VectorXi parameter_powers(const TensorBspline& bspline)
{
    return Eigen::VectorXi::Constant(bspline.heights.size(), 1);
}

} // namespace fettle
