// The path of a belt plan as a bounded least-squares problem, between two simulations. Not for other modules.

#pragma once

#include "belt/belt_plan.h"

#include <Eigen/Sparse>

#include <vector>

namespace fettle::belt {

/// The unknown of each point, which removal is proportional to: the force, or the inverse feed.
class PlannedValue {
  public:
    PlannedValue(bool by_force, double min, double max)
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

/// Flags of surfels.
using SurfelMask = Eigen::Array<bool, Eigen::Dynamic, 1>;

struct Simulation {
    Eigen::VectorXd residual; ///< displacement - target, mm; 0 where the displacement is NaN
    BeltRun run;
};

class BeltPlanner {
  public:
    /// @param surfels  before grinding; they must live as long as the planner
    BeltPlanner(const Surfels& surfels, const ContactWheel& wheel, const BeltPlanOptions& options);

    Simulation simulate(const std::vector<BeltPoint>& path) const;
    Eigen::VectorXd residual(const Surfels& surfels) const;
    /// Finds the best value that is the same at all points, by scaling it with the least-squares factor of the removal.
    Simulation find_constant(std::vector<BeltPoint>& path) const;
    /// Solves the problem linearised about the last simulation.
    /// @param weights  of the surfels' squared errors
    std::vector<BeltPoint> improved(const std::vector<BeltPoint>& path, const Simulation& last,
                                    const Eigen::VectorXd& weights) const;
    const PlannedValue& variable() const { return variable_; }

  private:
    std::vector<Eigen::Triplet<double>> jacobian(const std::vector<BeltPoint>& path, const Simulation& current,
                                                 const SurfelMask& counted) const;
    double mean_value(const std::vector<BeltPoint>& path) const;
    Eigen::ArrayXd exponents_of_inverse_feed(const std::vector<BeltPoint>& path) const;

    const Surfels& surfels_;
    const ContactWheel& wheel_;
    BeltPlanOptions options_;
    PlannedValue variable_;
};

} // namespace fettle::belt
