#include "surface/surface.h"

#include "core/constants.h"
#include "surface/griddata.h"
#include "surface/precision.h"
#include "surface/shapes.h"
#include "surface/tensor_bspline.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace fettle::surface {

namespace {

/// Slope of a griddata surface, which is piecewise cubic, by central differences. The step balances truncation (h²) and
/// roundoff (1e-16 / h).
Eigen::Vector2d slope(const Griddata& griddata, const Eigen::Vector2d& xy)
{
    constexpr double kDifferenceStep = 1e-4; // mm
    const double here = height(griddata, xy);
    Eigen::Vector2d result;
    for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d step = kDifferenceStep * Eigen::Vector2d::Unit(axis);
        const double above = height(griddata, xy + step);
        const double below = height(griddata, xy - step);
        // On the edge of the hull only one side is defined.
        result[axis] = std::isnan(above)   ? (here - below) / kDifferenceStep
                       : std::isnan(below) ? (above - here) / kDifferenceStep
                                           : (above - below) / (2 * kDifferenceStep);
    }
    return result;
}

double height_of(const Shape& shape, const Eigen::Vector2d& xy)
{
    return std::visit([&](const auto& s) { return height(s, xy); }, shape);
}

Eigen::Vector2d slope_of(const Shape& shape, const Eigen::Vector2d& xy)
{
    return std::visit([&](const auto& s) { return slope(s, xy); }, shape);
}

Eigen::VectorXd gradient_of(const Shape& shape, const Eigen::Vector2d& xy)
{
    return std::visit([&](const auto& s) { return height_gradient(s, xy); }, shape);
}

/// gᵀ C g over the nonzero entries of g: a spline's gradient has few.
double variance(const Shape& shape, const Eigen::MatrixXd& covariance, const Eigen::Vector2d& xy)
{
    const Eigen::VectorXd g = gradient_of(shape, xy);
    if (g.hasNaN()) return core::kNaN;
    std::vector<Eigen::Index> nonzero;
    for (Eigen::Index i = 0; i < g.size(); ++i)
        if (g[i] != 0) nonzero.push_back(i);
    const Eigen::VectorXd values = g(nonzero);
    return values.dot(covariance(nonzero, nonzero) * values);
}

struct ParameterPowers {
    using Powers = Eigen::VectorXi;
    Powers operator()(const Plane&) const { return Eigen::Vector3i(1, 0, 0); }
    Powers operator()(const Sphere&) const { return Eigen::Vector4i(1, 0, 0, -1); }
    Powers operator()(const Cylinder&) const { return Eigen::Vector<int, 5>(1, 0, 0, 0, -1); }
    Powers operator()(const Cone&) const { return Eigen::Vector<int, 6>(1, 0, 0, 0, -1, 0); }
    Powers operator()(const Torus&) const { return Eigen::Vector<int, 7>(1, 0, 0, 0, -1, 0, -1); }
    Powers operator()(const Quadric&) const { return Eigen::Vector<int, 9>(1, 0, 0, -1, -1, -1, -1, -1, -1); }
    Powers operator()(const Swept&) const { return Eigen::Vector<int, 5>(1, 1, 1, 1, 0); }
    Powers operator()(const Polynomial& polynomial) const { return Powers::Ones(polynomial.coefficients.size()); }
    Powers operator()(const Bspline& bspline) const { return Powers::Ones(bspline.heights.size()); }
    Powers operator()(const TensorBspline& bspline) const { return Powers::Ones(bspline.heights.size()); }
    Powers operator()(const Griddata& griddata) const { return Powers::Ones(griddata.points.cols()); }
};

constexpr std::size_t kGrain = 512; // points per task; below that, starting a thread takes longer than the work

/// Evaluates a function of x and y at the columns of `xy`, in parallel.
/// @param grain  points per task
template <typename Function>
Eigen::VectorXd evaluate(const Eigen::Matrix2Xd& xy, std::size_t grain, const Function& function)
{
    Eigen::VectorXd values(xy.cols());
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, xy.cols(), grain), [&](const auto& part) {
        for (Eigen::Index i = part.begin(); i < part.end(); ++i) values[i] = function(xy.col(i));
    });
    return values;
}

} // namespace

std::vector<WeightedShape> weighted_shapes(const Surface& surface)
{
    std::vector<WeightedShape> all = {{surface.weight, surface.shape, surface.covariance}};
    for (const Alternative& other : surface.alternatives)
        if (other.weight > 0) all.push_back({other.weight, other.shape, other.covariance});
    return all;
}

double height(const Surface& surface, const Eigen::Vector2d& xy)
{
    const double most_probable = height_of(surface.shape, xy);
    double z = most_probable;
    for (const Alternative& other : surface.alternatives) {
        if (!(other.weight > 0)) continue;
        const double difference = height_of(other.shape, xy) - most_probable;
        if (!std::isnan(difference)) z += other.weight * difference;
    }
    return z + surface.shift;
}

Eigen::VectorXd heights(const Surface& surface, const Eigen::Matrix2Xd& xy)
{
    return evaluate(xy, kGrain, [&](const Eigen::Vector2d& point) { return height(surface, point); });
}

Eigen::VectorXd heights(const Shape& shape, const Eigen::Matrix2Xd& xy)
{
    return evaluate(xy, kGrain, [&](const Eigen::Vector2d& point) { return height_of(shape, point); });
}

Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d most_probable = slope_of(surface.shape, xy);
    Eigen::Vector2d z_xy = most_probable;
    for (const Alternative& other : surface.alternatives) {
        if (!(other.weight > 0)) continue;
        const Eigen::Vector2d difference = slope_of(other.shape, xy) - most_probable;
        if (difference.allFinite()) z_xy += other.weight * difference;
    }
    return Eigen::Vector3d(-z_xy.x(), -z_xy.y(), 1).normalized();
}

bool has_touch_noise_only(const Surface& surface)
{
    return surface.covariance.size() > 0 &&
           (std::holds_alternative<Griddata>(surface.shape) || std::holds_alternative<TensorBspline>(surface.shape));
}

bool has_sigma(const Surface& surface)
{
    return (surface.covariance.size() > 0 || surface.precision) && !has_touch_noise_only(surface);
}

double sigma(const Surface& surface, const Eigen::Vector2d& xy)
{
    if (surface.precision) return sigmas(surface, xy)[0];
    if (surface.covariance.size() == 0) return core::kNaN;
    const double mean = height(surface, xy) - surface.shift;
    double within = 0, between = 0; // variance within the shapes, and of the shapes about their mean
    for (const WeightedShape& member : weighted_shapes(surface)) {
        const double z = height_of(member.shape, xy);
        if (std::isnan(z)) continue;
        within += member.weight * variance(member.shape, member.covariance, xy);
        between += member.weight * (z - mean) * (z - mean);
    }
    return std::isnan(mean) ? core::kNaN : std::sqrt(std::max(within + between, 0.0));
}

Eigen::VectorXd sigmas(const Surface& surface, const Eigen::Matrix2Xd& xy)
{
    if (surface.precision) return sigmas(std::get<Bspline>(surface.shape), *surface.precision, xy);
    return evaluate(xy, 1, [&](const Eigen::Vector2d& point) { return sigma(surface, point); });
}

Eigen::MatrixXd height_gradients(const Shape& shape, const Eigen::Matrix2Xd& xy)
{
    const Eigen::VectorXi powers = parameter_powers(shape);
    Eigen::MatrixXd gradients(powers.size(), xy.cols());
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, xy.cols(), kGrain), [&](const auto& part) {
        for (Eigen::Index i = part.begin(); i < part.end(); ++i) gradients.col(i) = gradient_of(shape, xy.col(i));
    });
    return gradients;
}

Eigen::VectorXi parameter_powers(const Shape& shape) { return std::visit(ParameterPowers{}, shape); }

} // namespace fettle::surface
