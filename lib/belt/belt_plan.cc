#include "belt/belt_plan.h"

#include "core/bounded_least_squares.h"
#include "core/error.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>

namespace fettle::belt {

namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

/// The unknown of each point, which removal is proportional to: the force, or the inverse feed.
class Variable {
  public:
    Variable(bool by_force, double min, double max)
        : by_force_(by_force), min_(by_force ? min : 1 / max), max_(by_force ? max : 1 / min)
    {
    }
    double min() const { return min_; }
    double max() const { return max_; }
    double value(const BeltPoint& point) const { return by_force_ ? point.load.value : 1 / point.feed; }
    void set(BeltPoint& point, double value) const { (by_force_ ? point.load.value : point.feed) = setting(value); }
    /// Force or feed for a value of the unknown.
    double setting(double value) const { return by_force_ ? value : 1 / value; }

  private:
    bool by_force_;
    double min_, max_;
};

using Mask = Eigen::Array<bool, Eigen::Dynamic, 1>; ///< surfels

struct Simulation {
    VectorXd residual; ///< displacement - target; 0 where the displacement is NaN
    BeltRun run;
};

/// Surfels that lose at least a quarter of the median removal.
Mask reached_surfels(const VectorXd& removed)
{
    constexpr double kMinShareOfMedian = 0.25;
    std::vector<double> depths;
    for (const double depth : removed)
        if (depth > 0) depths.push_back(depth);
    if (depths.empty()) throw core::InputError("the belt removes nothing along the path");
    return removed.array() >= kMinShareOfMedian * geometry::median(depths);
}

class Planner {
  public:
    Planner(const Surfels& surfels, const ContactWheel& wheel, const BeltPlanOptions& options)
        : surfels_(surfels), wheel_(wheel), options_(options), variable_(options.by_force, options.min, options.max)
    {
        options_.belt.keep_removals = true;
    }

    Simulation simulate(const std::vector<BeltPoint>& path) const
    {
        Surfels surfels = surfels_;
        Simulation result;
        result.run = grind(surfels, wheel_, path, options_.belt);
        result.residual = residual(surfels);
        return result;
    }

    VectorXd residual(const Surfels& surfels) const
    {
        return surfels.displacement.array().isNaN().select(0,
                                                           surfels.displacement.array() - options_.target_displacement);
    }

    /// Finds the best value that is the same at all points, by scaling it with the least-squares factor of the removal.
    Simulation find_constant(std::vector<BeltPoint>& path) const
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

    /// Derivative of each reached surfel's removal (row) by the relative change of each point's variable (column).
    std::vector<Eigen::Triplet<double>> jacobian(const std::vector<BeltPoint>& path, const Simulation& current,
                                                 const Mask& reached) const
    {
        std::vector<Eigen::Triplet<double>> entries;
        const auto add = [&](const SurfelRemoval& loss, double factor) {
            if (reached[loss.surfel]) entries.emplace_back(loss.surfel, loss.point, factor * loss.depth);
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

    /// Solves the problem linearised about the last simulation.
    /// @param weights  of the surfels' squared errors
    std::vector<BeltPoint> improved(const std::vector<BeltPoint>& path, const Simulation& last,
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
        const VectorXd best = core::bounded_least_squares(A, b, variable_.min() * current.cwiseInverse(),
                                                          variable_.max() * current.cwiseInverse(),
                                                          VectorXd::Ones(count), kGradientTolerance)
                                  .x;
        std::vector<BeltPoint> result = path;
        for (Index k = 0; k < count; ++k)
            if (result[k].is_on_part())
                variable_.set(result[k], std::clamp(best[k] * current[k], variable_.min(), variable_.max()));
        return result;
    }

    const Variable& variable() const { return variable_; }

  private:
    /// Mean over the points on the part.
    double mean_value(const std::vector<BeltPoint>& path) const
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
    ArrayXd exponents_of_inverse_feed(const std::vector<BeltPoint>& path) const
    {
        ArrayXd result = tributary_lengths(path);
        for (std::size_t k = 0; k < path.size(); ++k) {
            const double moving = result[k] / path[k].feed,
                         standing = std::pow(path[k].dwell, wheel_.law.dwell_exponent);
            result[k] = moving > 0 ? moving / (moving + standing) - wheel_.law.feed_exponent : 0;
        }
        return result;
    }

    const Surfels& surfels_;
    const ContactWheel& wheel_;
    BeltPlanOptions options_;
    Variable variable_;
};

double rms(const VectorXd& residual, const Mask& reached)
{
    return std::sqrt(reached.select(residual.array().square(), 0).sum() / reached.count());
}

/// The share of the area within a tolerance, as the aim of a plan.
class ShareWithin {
  public:
    ShareWithin(const Surfels& surfels, const ToleranceRange& range, double target)
        : areas_(surfels.area.size() > 0 ? ArrayXd(surfels.area) : ArrayXd(ArrayXd::Ones(surfels.size()))),
          has_stock_(!surfels.displacement.array().isNaN()), lower_(range.lower - target), upper_(range.upper - target)
    {
    }

    double share(const VectorXd& residual) const
    {
        const auto is_within = has_stock_ && residual.array() >= lower_ && residual.array() <= upper_;
        return is_within.select(areas_, 0).sum() / areas_.sum();
    }

    /// Weights of the squared errors (plan_belt()).
    /// @param counted  surfels   @param scale  of the errors at least, in their root mean squares
    VectorXd weights(const VectorXd& residual, const Mask& counted, double scale) const
    {
        constexpr double kWeightInside = 0.1; // keeps what lies in the middle from drifting to the limits
        const ArrayXd areas = counted.select(areas_, 0), error = residual.array() - (lower_ + upper_) / 2;
        const double rms = std::sqrt((areas * error.square()).sum() / areas.sum());
        const ArrayXd square = (error / std::max((upper_ - lower_) / 2, scale * rms)).square();
        const ArrayXd slope = 4 * square / (1 + square.square()).square();
        return areas * (static_cast<double>((areas > 0).count()) / areas.sum()) * (kWeightInside + slope);
    }

  private:
    ArrayXd areas_;
    Mask has_stock_;
    double lower_, upper_; ///< limits of the residual, mm
};

} // namespace

BeltPlan plan_belt(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                   const BeltPlanOptions& options, const core::Progress& progress)
{
    for (std::size_t k = 0; k < path.size(); ++k)
        if (options.by_force && path[k].is_on_part() && !path[k].load.by_force)
            throw core::InputError("point " + std::to_string(k) +
                                   ": is pressed to a depth, so no force can be planned");
    if (std::none_of(path.begin(), path.end(), [](const BeltPoint& p) { return p.is_on_part(); }))
        throw core::InputError("no point is on the part");
    const Planner planner(surfels, wheel, options);
    BeltPlan plan;
    std::vector<BeltPoint> current = path;
    Simulation simulation = planner.find_constant(current);
    const Mask has_stock = !surfels.displacement.array().isNaN();
    const Mask touched = simulation.run.removed.array() > 0 && has_stock;
    const Mask reached = reached_surfels(simulation.run.removed) && has_stock;
    const VectorXd before = planner.residual(surfels);
    plan.touched = (simulation.run.removed.array() > 0).count();
    plan.reached = reached.count();
    plan.rms_before = rms(before, reached);
    plan.rms_planned = plan.rms_constant = rms(simulation.residual, reached);
    plan.time_planned = plan.time_constant = simulation.run.trace.back().time;
    std::optional<ShareWithin> within;
    if (options.tolerance) {
        within.emplace(surfels, *options.tolerance, options.target_displacement);
        const double constant = within->share(simulation.residual);
        plan.within = {within->share(before), constant, constant};
    }
    plan.path = current;
    for (const BeltPoint& point : current)
        if (point.is_on_part()) plan.constant = planner.variable().setting(planner.variable().value(point));
    // Of the error, and of the share within: less is not worth another simulation.
    constexpr double kMinDecrease = 0.01, kMinGain = 0.0005;
    int idle_rounds = 0;
    bool is_close = false; // to the largest share: now also the rim counts, and what is out of reach does not
    const auto weights = [&](const VectorXd& residual) -> VectorXd {
        if (!within) return reached.cast<double>();
        return within->weights(residual, is_close ? touched : reached, is_close ? 1 : 2);
    };
    while (plan.rounds < options.max_rounds && !plan.converged) {
        core::report_progress(progress, static_cast<double>(plan.rounds++) / options.max_rounds);
        current = planner.improved(current, simulation, weights(simulation.residual));
        simulation = planner.simulate(current);
        const double error = rms(simulation.residual, reached);
        const double share = within ? within->share(simulation.residual) : 0;
        const bool is_idle =
            within ? share < plan.within->planned + kMinGain : error > (1 - kMinDecrease) * plan.rms_planned;
        if (within ? share > plan.within->planned : error <= plan.rms_planned) {
            plan.rms_planned = error;
            if (within) plan.within->planned = share;
            plan.time_planned = simulation.run.trace.back().time;
            plan.path = current;
        }
        idle_rounds = is_idle ? idle_rounds + 1 : 0;
        plan.converged = is_idle && (!within || (is_close && idle_rounds > 1));
        is_close = is_close || is_idle;
    }
    for (const BeltPoint& point : plan.path)
        if (point.is_on_part()) {
            const double setting = planner.variable().setting(planner.variable().value(point));
            plan.at_min += setting <= options.min * (1 + 1e-12) ? 1 : 0;
            plan.at_max += setting >= options.max * (1 - 1e-12) ? 1 : 0;
        }
    return plan;
}

} // namespace fettle::belt
