#include "belt/belt_plan.h"

#include "core/bounded_least_squares.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

/// What is chosen at each point: the force, or the inverse feed, which removal is proportional to.
class Choice {
  public:
    Choice(bool by_force, double least, double most) : by_force_(by_force)
    {
        least_ = by_force ? least : 1 / most;
        most_ = by_force ? most : 1 / least;
    }
    double least() const { return least_; }
    double most() const { return most_; }
    double of(const BeltPoint& point) const { return by_force_ ? point.pressing.amount : 1 / point.feed; }
    void set(BeltPoint& point, double value) const { (by_force_ ? point.pressing.amount : point.feed) = shown(value); }
    double shown(double value) const { return by_force_ ? value : 1 / value; }

  private:
    bool by_force_;
    double least_, most_;
};

using Which = Eigen::Array<bool, Eigen::Dynamic, 1>; ///< surfels

struct Ground {
    VectorXd left; ///< displacement - wanted; 0 where it is not known
    BeltRun run;
};

Which reached(const VectorXd& removed)
{
    constexpr double kShare = 0.25;
    std::vector<double> depths;
    for (const double depth : removed)
        if (depth > 0) depths.push_back(depth);
    if (depths.empty()) throw InputError("the belt takes nothing along the path");
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return removed.array() >= kShare * *middle;
}

class Planner {
  public:
    Planner(const Surfels& surfels, const ContactWheel& wheel, const BeltPlanOptions& options)
        : surfels_(surfels), wheel_(wheel), options_(options), choice_(options.by_force, options.least, options.most)
    {
        options_.belt.keeps_losses = true;
    }

    Ground ground(const std::vector<BeltPoint>& path) const
    {
        Surfels surfels = surfels_;
        Ground result;
        result.run = grind(surfels, wheel_, path, options_.belt);
        result.left = left(surfels);
        return result;
    }

    VectorXd left(const Surfels& surfels) const
    {
        return surfels.displacement.array().isNaN().select(0, surfels.displacement.array() - options_.wanted);
    }

    /// All points alike; then as much more of it, or less, as is best.
    Ground find_constant(std::vector<BeltPoint>& path) const
    {
        constexpr int kMost = 6;
        constexpr double kEnough = 0.005;
        double value = 0, count = 0;
        for (const BeltPoint& point : path)
            if (point.is_on()) {
                value += choice_.of(point);
                ++count;
            }
        value = std::clamp(value / count, choice_.least(), choice_.most());
        for (int round = 0;; ++round) {
            for (BeltPoint& point : path)
                if (point.is_on()) choice_.set(point, value);
            Ground now = ground(path);
            const VectorXd& removed = now.run.removed;
            if (removed.isZero(0)) return now;
            const double more = removed.dot(now.left) / removed.squaredNorm();
            const double next = std::clamp(value * std::max(1 + more, 0.1), choice_.least(), choice_.most());
            if (round + 1 == kMost || std::abs(next / value - 1) < kEnough) return now;
            value = next;
        }
    }

    /// What more each point (column) would take from each surfel (row) reached, for each time its choice; of now.
    std::vector<Eigen::Triplet<double>> slopes(const std::vector<BeltPoint>& path, const Ground& now,
                                               const Which& counts) const
    {
        std::vector<Eigen::Triplet<double>> entries;
        const auto add = [&](const BeltLoss& loss, double factor) {
            if (counts[loss.surfel])
                entries.emplace_back(static_cast<int>(loss.surfel), static_cast<int>(loss.point), factor * loss.depth);
        };
        if (!options_.by_force) {
            const ArrayXd exponent = exponents_of_inverse_feed(path);
            for (const BeltLoss& loss : now.run.losses) add(loss, exponent[static_cast<Index>(loss.point)]);
            return entries;
        }
        // With the force the contact grows, too.
        constexpr double kStep = 0.1;
        std::vector<BeltPoint> harder = path;
        for (BeltPoint& point : harder) point.pressing.amount *= 1 + kStep;
        for (const BeltLoss& loss : ground(harder).run.losses) add(loss, 1 / kStep);
        for (const BeltLoss& loss : now.run.losses) add(loss, -1 / kStep);
        return entries;
    }

    /// The best choices by what the last run took.
    std::vector<BeltPoint> improved(const std::vector<BeltPoint>& path, const Ground& last, const Which& counts) const
    {
        // Unknown is the choice over that of now, of each point that is on the part: 1 changes nothing. Where the wheel
        // is off the part there is nothing to choose: any number will do there, and no row asks for it.
        const auto count = static_cast<Index>(path.size());
        VectorXd now = VectorXd::Constant(count, choice_.least());
        double sum = 0, on = 0;
        for (Index k = 0; k < count; ++k) {
            if (!path[static_cast<std::size_t>(k)].is_on()) continue;
            now[k] = choice_.of(path[static_cast<std::size_t>(k)]);
            sum += now[k];
            ++on;
        }
        const double mean = sum / on;
        std::vector<Eigen::Triplet<double>> entries = slopes(path, last, counts);
        VectorXd b = counts.select(last.left.array(), 0);
        for (const Eigen::Triplet<double>& slope : entries) b[slope.row()] += slope.value();
        Index row = b.size();
        for (Index k = 1; k < count; ++k) {
            if (path[static_cast<std::size_t>(k)].begins_run || !path[static_cast<std::size_t>(k)].is_on()) continue;
            entries.emplace_back(static_cast<int>(row), static_cast<int>(k - 1),
                                 options_.smoothness * now[k - 1] / mean);
            entries.emplace_back(static_cast<int>(row), static_cast<int>(k), -options_.smoothness * now[k] / mean);
            ++row;
        }
        Eigen::SparseMatrix<double> A(row, count);
        A.setFromTriplets(entries.begin(), entries.end());
        b.conservativeResizeLike(VectorXd::Zero(row));
        constexpr double kEnough = 1e-4; // of the slope: the next simulation changes more
        const VectorXd best = bounded_least_squares(A, b, choice_.least() * now.cwiseInverse(),
                                                    choice_.most() * now.cwiseInverse(), VectorXd::Ones(count), kEnough)
                                  .x;
        std::vector<BeltPoint> better = path;
        for (Index k = 0; k < count; ++k)
            if (better[static_cast<std::size_t>(k)].is_on())
                choice_.set(better[static_cast<std::size_t>(k)],
                            std::clamp(best[k] * now[k], choice_.least(), choice_.most()));
        return better;
    }

    const Choice& choice() const { return choice_; }

  private:
    /// Depth goes with this power of the inverse feed, at each point: less where the wheel stands besides.
    ArrayXd exponents_of_inverse_feed(const std::vector<BeltPoint>& path) const
    {
        ArrayXd result = ways(path);
        for (std::size_t k = 0; k < path.size(); ++k) {
            double& at = result[static_cast<Index>(k)];
            const double moving = at / path[k].feed, standing = std::pow(path[k].dwell, wheel_.law.dwell);
            at = moving > 0 ? moving / (moving + standing) - wheel_.law.feed : 0;
        }
        return result;
    }

    const Surfels& surfels_;
    const ContactWheel& wheel_;
    BeltPlanOptions options_;
    Choice choice_;
};

double rms(const VectorXd& left, const Which& counts)
{
    return std::sqrt(counts.select(left.array().square(), 0).sum() / static_cast<double>(counts.count()));
}

} // namespace

BeltPlan plan_belt(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                   const BeltPlanOptions& options, const Progress& progress)
{
    for (std::size_t k = 0; k < path.size(); ++k)
        if (options.by_force && path[k].is_on() && !path[k].pressing.by_force)
            throw InputError("point " + std::to_string(k) + ": is pressed to a depth, so no force can be chosen");
    if (std::none_of(path.begin(), path.end(), [](const BeltPoint& p) { return p.is_on(); }))
        throw InputError("no point is on the part");
    constexpr double kEnough = 0.01; // of the error: less is not worth another simulation
    const Planner planner(surfels, wheel, options);
    BeltPlan plan;
    std::vector<BeltPoint> now = path;
    Ground ground = planner.find_constant(now);
    const Which counts = reached(ground.run.removed) && !surfels.displacement.array().isNaN();
    plan.touched = (ground.run.removed.array() > 0).count();
    plan.reached = counts.count();
    plan.rms_before = rms(planner.left(surfels), counts);
    plan.rms_planned = plan.rms_constant = rms(ground.left, counts);
    plan.time_planned = plan.time_constant = ground.run.trace.back().time;
    plan.path = now;
    for (const BeltPoint& point : now)
        if (point.is_on()) plan.constant = planner.choice().shown(planner.choice().of(point));
    while (plan.rounds < options.rounds && !plan.converged) {
        tell(progress, static_cast<double>(plan.rounds++) / options.rounds);
        now = planner.improved(now, ground, counts);
        ground = planner.ground(now);
        const double error = rms(ground.left, counts);
        plan.converged = error > (1 - kEnough) * plan.rms_planned;
        if (error > plan.rms_planned) break;
        plan.rms_planned = error;
        plan.time_planned = ground.run.trace.back().time;
        plan.path = now;
    }
    for (const BeltPoint& point : plan.path)
        if (point.is_on()) {
            const double value = planner.choice().shown(planner.choice().of(point));
            plan.at_least += value <= options.least * (1 + 1e-12) ? 1 : 0;
            plan.at_most += value >= options.most * (1 - 1e-12) ? 1 : 0;
        }
    return plan;
}

} // namespace fettle
