#include "surface/surface.h"

#include "core/constants.h"
#include "surface/griddata.h"
#include "surface/precision.h"
#include "surface/shapes.h"
#include "surface/tensor_bspline.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace fettle {

namespace {

/// Griddata is piecewise: its slope by differences over a step that balances truncation (h²) and roundoff (1e-16 / h).
Eigen::Vector2d slope(const Griddata& griddata, const Eigen::Vector2d& xy)
{
    constexpr double kStep = 1e-4; // mm
    const double here = height(griddata, xy);
    Eigen::Vector2d result;
    for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
        const double above = height(griddata, xy + step);
        const double below = height(griddata, xy - step);
        // At the edge of the hull one side is not defined.
        result[axis] = std::isnan(above)   ? (here - below) / kStep
                       : std::isnan(below) ? (above - here) / kStep
                                           : (above - below) / (2 * kStep);
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

/// gᵀ C g. Only few entries of a spline's gradient differ from 0.
double variance(const Shape& shape, const Eigen::MatrixXd& covariance, const Eigen::Vector2d& xy)
{
    const Eigen::VectorXd g = gradient_of(shape, xy);
    if (g.hasNaN()) return kNaN;
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < g.size(); ++i)
        if (g[i] != 0) used.push_back(i);
    const Eigen::VectorXd few = g(used);
    return few.dot(covariance(used, used) * few);
}

} // namespace

std::vector<Member> members(const Surface& surface)
{
    std::vector<Member> all = {{surface.weight, surface.shape, surface.covariance}};
    for (const Alternative& other : surface.alternatives)
        if (other.weight > 0) all.push_back({other.weight, other.shape, other.covariance});
    return all;
}

double height(const Surface& surface, const Eigen::Vector2d& xy)
{
    const double likeliest = height_of(surface.shape, xy);
    double z = likeliest;
    for (const Alternative& other : surface.alternatives) {
        if (!(other.weight > 0)) continue;
        const double difference = height_of(other.shape, xy) - likeliest;
        if (!std::isnan(difference)) z += other.weight * difference;
    }
    return z + surface.shift;
}

Eigen::VectorXd heights(const Surface& surface, const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    tbb::parallel_for(Eigen::Index{0}, xy.cols(), [&](Eigen::Index i) { z[i] = height(surface, xy.col(i)); });
    return z;
}

Eigen::VectorXd heights(const Shape& shape, const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    tbb::parallel_for(Eigen::Index{0}, xy.cols(), [&](Eigen::Index i) { z[i] = height_of(shape, xy.col(i)); });
    return z;
}

Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d likeliest = slope_of(surface.shape, xy);
    Eigen::Vector2d z_xy = likeliest;
    for (const Alternative& other : surface.alternatives) {
        if (!(other.weight > 0)) continue;
        const Eigen::Vector2d difference = slope_of(other.shape, xy) - likeliest;
        if (difference.allFinite()) z_xy += other.weight * difference;
    }
    return Eigen::Vector3d(-z_xy.x(), -z_xy.y(), 1).normalized();
}

bool knows_sigma(const Surface& surface) { return surface.covariance.size() > 0 || surface.precision; }

double sigma(const Surface& surface, const Eigen::Vector2d& xy)
{
    if (surface.precision) return sigmas(surface, xy)[0];
    if (surface.covariance.size() == 0) return kNaN;
    const double mean = height(surface, xy) - surface.shift;
    double sum = 0, spread = 0; // within the members, and of them about their mean
    for (const Member& member : members(surface)) {
        const double z = height_of(member.shape, xy);
        if (std::isnan(z)) continue;
        sum += member.weight * variance(member.shape, member.covariance, xy);
        spread += member.weight * (z - mean) * (z - mean);
    }
    return std::isnan(mean) ? kNaN : std::sqrt(std::max(sum + spread, 0.0));
}

Eigen::VectorXd sigmas(const Surface& surface, const Eigen::Matrix2Xd& xy)
{
    if (surface.precision) return sigmas(std::get<Bspline>(surface.shape), *surface.precision, xy);
    Eigen::VectorXd result(xy.cols());
    tbb::parallel_for(Eigen::Index{0}, xy.cols(), [&](Eigen::Index i) { result[i] = sigma(surface, xy.col(i)); });
    return result;
}

Eigen::MatrixXd height_gradients(const Shape& shape, const Eigen::Matrix2Xd& xy)
{
    const Eigen::VectorXi powers = parameter_powers(shape);
    Eigen::MatrixXd gradients(powers.size(), xy.cols());
    constexpr std::size_t kGrain = 512; // points: fewer take less time than it takes to wake another thread
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, xy.cols(), kGrain), [&](const auto& part) {
        for (Eigen::Index i = part.begin(); i < part.end(); ++i) gradients.col(i) = gradient_of(shape, xy.col(i));
    });
    return gradients;
}

Eigen::VectorXi parameter_powers(const Shape& shape)
{
    return std::visit([](const auto& s) { return parameter_powers(s); }, shape);
}

} // namespace fettle
