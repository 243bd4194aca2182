#include "belt/belt_plan.h"

#include "belt/belt_planner.h"
#include "core/error.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace fettle::belt {
namespace {

using Eigen::ArrayXd;
using Eigen::VectorXd;

/// Surfels that lose at least a quarter of the median removal.
SurfelMask reached_surfels(const VectorXd& removed)
{
    constexpr double kMinShareOfMedian = 0.25;
    std::vector<double> depths;
    for (const double depth : removed)
        if (depth > 0) depths.push_back(depth);
    if (depths.empty()) throw core::InputError("the belt removes nothing along the path");
    return removed.array() >= kMinShareOfMedian * geometry::median(depths);
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
    VectorXd weights(const VectorXd& residual, const SurfelMask& counted, double scale) const
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
    SurfelMask has_stock_;
    double lower_, upper_; ///< limits of the residual, mm
};

/// What a plan is judged by: the share of the area within the tolerance, without one the root mean square of the error.
class Aim {
  public:
    /// @param removed  depth that each surfel loses on the path with the constant, mm
    Aim(const Surfels& surfels, const VectorXd& removed, const BeltPlanOptions& options)
        : by_share_(options.tolerance),
          within_(surfels, options.tolerance.value_or(ToleranceRange{}), options.target_displacement)
    {
        const SurfelMask has_stock = !surfels.displacement.array().isNaN();
        touched_ = removed.array() > 0 && has_stock;
        reached_ = reached_surfels(removed) && has_stock;
    }

    Eigen::Index reached() const { return reached_.count(); }
    bool by_share() const { return by_share_; }
    /// Root mean square over the surfels reached, mm.
    double error(const VectorXd& residual) const
    {
        return std::sqrt(reached_.select(residual.array().square(), 0).sum() / reached_.count());
    }
    double share(const VectorXd& residual) const { return by_share_ ? within_.share(residual) : 0; }
    /// Weights of the squared errors.
    /// @param is_close  to the largest share: now also the rim counts, and what is out of reach does not
    VectorXd weights(const VectorXd& residual, bool is_close) const
    {
        if (!by_share_) return reached_.cast<double>();
        return within_.weights(residual, is_close ? touched_ : reached_, is_close ? 1 : 2);
    }

  private:
    SurfelMask touched_, reached_;
    bool by_share_;
    ShareWithin within_;
};

/// @throws InputError where nothing can be planned
void check_points(const std::vector<BeltPoint>& path, bool by_force)
{
    for (std::size_t k = 0; k < path.size(); ++k)
        if (by_force && path[k].is_on_part() && !path[k].load.by_force)
            throw core::InputError("point " + std::to_string(k) +
                                   ": is pressed to a depth, so no force can be planned");
    if (std::none_of(path.begin(), path.end(), [](const BeltPoint& p) { return p.is_on_part(); }))
        throw core::InputError("no point is on the part");
}

/// The path with the constant as the first plan.
BeltPlan first_plan(const Aim& aim, const BeltPlanner& planner, const VectorXd& before, std::vector<BeltPoint> path,
                    const Simulation& simulation)
{
    BeltPlan plan;
    plan.touched = (simulation.run.removed.array() > 0).count();
    plan.reached = aim.reached();
    plan.rms_before = aim.error(before);
    plan.rms_planned = plan.rms_constant = aim.error(simulation.residual);
    plan.time_planned = plan.time_constant = simulation.run.trace.back().time;
    if (aim.by_share()) {
        const double constant = aim.share(simulation.residual);
        plan.within = {aim.share(before), constant, constant};
    }
    for (const BeltPoint& point : path)
        if (point.is_on_part()) plan.constant = planner.variable().setting(planner.variable().value(point));
    plan.path = std::move(path);
    return plan;
}

/// Solves and simulates by turns until the plan gets no better.
void improve(BeltPlan& plan, const Aim& aim, const BeltPlanner& planner, Simulation simulation, int max_rounds,
             const core::Progress& progress)
{
    // Where error and share within gain less than these, another simulation is not worth its time.
    constexpr double kMinDecrease = 0.01, kMinGain = 0.0005;
    std::vector<BeltPoint> path = plan.path;
    int idle_rounds = 0;
    bool is_close = false;
    while (plan.rounds < max_rounds && !plan.converged) {
        core::report_progress(progress, static_cast<double>(plan.rounds++) / max_rounds);
        path = planner.improved(path, simulation, aim.weights(simulation.residual, is_close));
        simulation = planner.simulate(path);
        const double error = aim.error(simulation.residual), share = aim.share(simulation.residual);
        const bool is_idle =
            plan.within ? share < plan.within->planned + kMinGain : error > (1 - kMinDecrease) * plan.rms_planned;
        if (plan.within ? share > plan.within->planned : error <= plan.rms_planned) {
            plan.rms_planned = error;
            if (plan.within) plan.within->planned = share;
            plan.time_planned = simulation.run.trace.back().time;
            plan.path = path;
        }
        idle_rounds = is_idle ? idle_rounds + 1 : 0;
        plan.converged = is_idle && (!plan.within || (is_close && idle_rounds > 1));
        is_close = is_close || is_idle;
    }
}

void count_points_at_limits(BeltPlan& plan, const PlannedValue& variable, double min, double max)
{
    constexpr double kRounding = 1e-12; // relative, of a value that was limited as its inverse
    for (const BeltPoint& point : plan.path) {
        if (!point.is_on_part()) continue;
        const double setting = variable.setting(variable.value(point));
        plan.at_min += setting <= min * (1 + kRounding) ? 1 : 0;
        plan.at_max += setting >= max * (1 - kRounding) ? 1 : 0;
    }
}

} // namespace

BeltPlan plan_belt(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                   const BeltPlanOptions& options, const core::Progress& progress)
{
    check_points(path, options.by_force);
    const BeltPlanner planner(surfels, wheel, options);
    std::vector<BeltPoint> constant = path;
    Simulation simulation = planner.find_constant(constant);
    const Aim aim(surfels, simulation.run.removed, options);
    BeltPlan plan = first_plan(aim, planner, planner.residual(surfels), std::move(constant), simulation);
    improve(plan, aim, planner, std::move(simulation), options.max_rounds, progress);
    count_points_at_limits(plan, planner.variable(), options.min, options.max);
    return plan;
}

} // namespace fettle::belt
