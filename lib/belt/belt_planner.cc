#include "belt/belt_planner.h"

#include "core/bounded_least_squares.h"

#include <algorithm>
#include <cmath>

namespace fettle::belt {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

BeltPlanner::BeltPlanner(const Surfels& surfels, const ContactWheel& wheel, const BeltPlanOptions& options)
    : surfels_(surfels), wheel_(wheel), options_(options), variable_(options.by_force, options.min, options.max)
{
    options_.belt.keep_removals = true;
}

Simulation BeltPlanner::simulate(const std::vector<BeltPoint>& path) const
{
    Surfels surfels = surfels_;
    Simulation result;
    result.run = grind(surfels, wheel_, path, options_.belt);
    result.residual = residual(surfels);
    return result;
}

VectorXd BeltPlanner::residual(const Surfels& surfels) const
{
    return surfels.displacement.array().isNaN().select(0, surfels.displacement.array() - options_.target_displacement);
}

Simulation BeltPlanner::find_constant(std::vector<BeltPoint>& path) const
{
    constexpr int kMaxIterations = 6;
    constexpr double kStartTolerance = 0.02,
                     kOwnTolerance = 0.001; // relative: where it is only the start, or the answer too
    const double relative_tolerance = options_.tolerance ? kStartTolerance : kOwnTolerance;
    double value = std::clamp(mean_value(path), variable_.min(), variable_.max());
    for (int iteration = 1;; ++iteration) {
        for (BeltPoint& point : path)
            if (point.is_on_part()) variable_.set(point, value);
        Simulation current = simulate(path);
        const VectorXd& removed = current.run.removed;
        if (removed.isZero(0)) return current;
        const double correction = removed.dot(current.residual) / removed.squaredNorm();
        const double next = std::clamp(value * std::max(1 + correction, 0.1), variable_.min(), variable_.max());
        if (iteration == kMaxIterations || std::abs(next / value - 1) < relative_tolerance) return current;
        value = next;
    }
}

/// Derivative of each counted surfel's removal (row) by the relative change of each point's variable (column).
std::vector<Eigen::Triplet<double>> BeltPlanner::jacobian(const std::vector<BeltPoint>& path, const Simulation& current,
                                                          const SurfelMask& counted) const
{
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](const SurfelRemoval& loss, double factor) {
        if (counted[loss.surfel]) entries.emplace_back(loss.surfel, loss.point, factor * loss.depth);
    };
    if (!options_.by_force) {
        const ArrayXd exponent = exponents_of_inverse_feed(path);
        for (const SurfelRemoval& loss : current.run.removals) add(loss, exponent[loss.point]);
        return entries;
    }
    // A finite difference, since the contact area grows with the force.
    constexpr double kRelativeStep = 0.1;
    std::vector<BeltPoint> stepped = path;
    for (BeltPoint& point : stepped) point.load.value *= 1 + kRelativeStep;
    for (const SurfelRemoval& loss : simulate(stepped).run.removals) add(loss, 1 / kRelativeStep);
    for (const SurfelRemoval& loss : current.run.removals) add(loss, -1 / kRelativeStep);
    return entries;
}

std::vector<BeltPoint> BeltPlanner::improved(const std::vector<BeltPoint>& path, const Simulation& last,
                                             const VectorXd& weights) const
{
    // The unknowns are the variables relative to their current values: 1 changes nothing. Points off the part have
    // an empty column, so their value is arbitrary.
    const Index count = std::ssize(path);
    VectorXd current = VectorXd::Constant(count, variable_.min());
    for (Index k = 0; k < count; ++k)
        if (path[k].is_on_part()) current[k] = variable_.value(path[k]);
    const double mean = mean_value(path);
    std::vector<Eigen::Triplet<double>> entries = jacobian(path, last, weights.array() > 0);
    VectorXd b = last.residual;
    for (const Eigen::Triplet<double>& entry : entries) b[entry.row()] += entry.value();
    const VectorXd scales = weights.cwiseSqrt();
    b = b.cwiseProduct(scales);
    for (Eigen::Triplet<double>& entry : entries)
        entry = {entry.row(), entry.col(), scales[entry.row()] * entry.value()};
    Index row = b.size();
    for (Index k = 1; k < count; ++k) {
        if (path[k].touches_down || !path[k].is_on_part()) continue;
        entries.emplace_back(row, k - 1, options_.smoothness * current[k - 1] / mean);
        entries.emplace_back(row, k, -options_.smoothness * current[k] / mean);
        ++row;
    }
    Eigen::SparseMatrix<double> A(row, count);
    A.setFromTriplets(entries.begin(), entries.end());
    b.conservativeResizeLike(VectorXd::Zero(row));
    constexpr double kGradientTolerance = 1e-4; // relative; the next simulation changes more
    const VectorXd best =
        core::bounded_least_squares(A, b, variable_.min() * current.cwiseInverse(),
                                    variable_.max() * current.cwiseInverse(), VectorXd::Ones(count), kGradientTolerance)
            .x;
    std::vector<BeltPoint> result = path;
    for (Index k = 0; k < count; ++k)
        if (result[k].is_on_part())
            variable_.set(result[k], std::clamp(best[k] * current[k], variable_.min(), variable_.max()));
    return result;
}

/// Mean over the points on the part.
double BeltPlanner::mean_value(const std::vector<BeltPoint>& path) const
{
    double sum = 0, count = 0;
    for (const BeltPoint& point : path) {
        if (!point.is_on_part()) continue;
        sum += variable_.value(point);
        ++count;
    }
    return sum / count;
}

/// Exponent of depth over inverse feed at each point. Dwell reduces it, since it removes at any feed.
ArrayXd BeltPlanner::exponents_of_inverse_feed(const std::vector<BeltPoint>& path) const
{
    ArrayXd result = tributary_lengths(path);
    for (std::size_t k = 0; k < path.size(); ++k) {
        const double moving = result[k] / path[k].feed, standing = std::pow(path[k].dwell, wheel_.law.dwell_exponent);
        result[k] = moving > 0 ? moving / (moving + standing) - wheel_.law.feed_exponent : 0;
    }
    return result;
}

} // namespace fettle::belt
