#include "sampling/hillclimb.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/uniform_draws.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fettle::sampling {

namespace {

constexpr int kMaxCandidates = 100000;
// A candidate closer to an edge than this is on it, despite rounding. Boundary points are on sound metal.
constexpr double kEdgeToleranceSpacings = 1e-6;

using Subset = std::vector<Eigen::Index>;

/// State of the search: the current subset of the candidates and the best one.
class HillClimber {
  public:
    HillClimber(Eigen::Index candidates, const SubsetError& error, const HillClimbOptions& options)
        : count_(candidates), error_(error), options_(options), random_(options.seed)
    {
    }

    HillClimbResult run()
    {
        start();
        for (int i = 0; i < options_.mutations; ++i) mutate();
        best_ = current_;
        discard();
        if (options_.touches > 0) {
            best_inside_ = inside_;
            best_ = current_;
            for (int i = 0; i < kExchangesPerMutation * options_.mutations; ++i) exchange();
            inside_ = best_inside_;
            current_ = best_;
        }
        if (!std::isfinite(current_))
            throw core::InputError(
                "no subset of the candidates that was tried covers the anomaly: more touches or a wider "
                "sampling boundary are needed");
        std::ranges::sort(inside_);
        return {inside_, current_, start_error_, evaluations_};
    }

  private:
    std::size_t random_index(std::size_t count) { return geometry::draw_index(random_, count); }

    double error_of(Subset subset)
    {
        ++evaluations_;
        std::ranges::sort(subset);
        const double error = error_(subset);
        return std::isnan(error) ? core::kInfinity : error;
    }

    void start()
    {
        Subset order(count_);
        std::iota(order.begin(), order.end(), Eigen::Index{0});
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_index(i)]);
        const auto half = order.begin() + std::max(count_ / 2, options_.touches);
        inside_.assign(order.begin(), half);
        outside_.assign(half, order.end());
        start_error_ = current_ = error_of(inside_);
    }

    std::size_t min_size() const { return std::max<Eigen::Index>(options_.touches, 1); }

    static void move(Subset& from, std::size_t which, Subset& to)
    {
        to.push_back(from[which]);
        from[which] = from.back();
        from.pop_back();
    }

    /// Moves a random candidate into or out of the subset, unless too few are left; undoes it if the error increases.
    void mutate()
    {
        const std::size_t which = random_index(count_);
        const bool leaves = which < inside_.size();
        if (leaves && inside_.size() <= min_size()) return;
        Subset& from = leaves ? inside_ : outside_;
        Subset& to = leaves ? outside_ : inside_;
        move(from, leaves ? which : which - inside_.size(), to);
        const double error = error_of(inside_);
        if (error <= current_)
            current_ = error;
        else
            move(to, to.size() - 1, from);
    }

    /// Accepts with probability exp(-k max(error - best, 0)); draws a random number only for errors above the best.
    bool accept(double error)
    {
        if (error <= best_) return true;
        if (!std::isfinite(error)) return false;
        return geometry::draw_uniform(random_) < std::exp(-options_.sharpness * (error - best_));
    }

    void discard()
    {
        Eigen::Index cheapest = -1;
        double min_error = core::kInfinity;
        // The first `untried` members were not tried since the last discard, the others were rejected.
        std::size_t untried = inside_.size();
        while (inside_.size() > min_size()) {
            if (untried == 0) {
                if (options_.touches == 0) return;
                const auto which = cheapest < 0 ? random_index(inside_.size()) : static_cast<std::size_t>(cheapest);
                leave_out(which, min_error);
            } else {
                const std::size_t which = random_index(untried);
                Subset fewer = inside_;
                fewer.erase(fewer.begin() + which);
                const double error = error_of(fewer);
                if (accept(error)) {
                    leave_out(which, error);
                } else {
                    std::swap(inside_[which], inside_[--untried]);
                    if (error < min_error) {
                        min_error = error;
                        cheapest = untried;
                    }
                    continue;
                }
            }
            untried = inside_.size();
            cheapest = -1;
            min_error = core::kInfinity;
        }
    }

    void leave_out(std::size_t which, double error)
    {
        move(inside_, which, outside_);
        current_ = error;
        best_ = std::min(best_, error);
    }

    /// Exchanges one random member for one candidate outside.
    void exchange()
    {
        if (outside_.empty()) return;
        const std::size_t in = random_index(inside_.size()), out = random_index(outside_.size());
        std::swap(inside_[in], outside_[out]);
        const double error = error_of(inside_);
        if (!accept(error)) {
            std::swap(inside_[in], outside_[out]);
            return;
        }
        current_ = error;
        if (error < best_) {
            best_ = error;
            best_inside_ = inside_;
        }
    }

    Eigen::Index count_;
    const SubsetError& error_;
    HillClimbOptions options_;
    std::mt19937_64 random_;
    Subset inside_, outside_, best_inside_;
    double current_ = core::kInfinity, best_ = core::kInfinity, start_error_ = core::kInfinity;
    int evaluations_ = 0;
};

} // namespace

Eigen::Matrix2Xd candidate_touches(const job::Job& job, double spacing)
{
    const job::Boundaries both = job::working_boundaries(job);
    const job::Polygon& outer = both.sampling;
    if (spacing <= 0) spacing = std::sqrt((job::area(outer) - job::area(both.anomaly)) / kDefaultCandidates);
    const Eigen::AlignedBox2d box = geometry::bounding_box(outer);
    const Eigen::Vector2d size = box.sizes();
    const Eigen::Vector2d steps = (size / spacing).array().floor();
    if ((steps.array() + 1).prod() > kMaxCandidates)
        throw core::InputError("a spacing of " + core::to_short_text(spacing / job.units.mm()) + " " +
                               units::to_string(job.units.length) + " gives more than " +
                               std::to_string(kMaxCandidates) + " candidates");
    std::vector<Eigen::Vector2d> places;
    for (double row = 0; row <= steps.y(); ++row)
        for (double column = 0; column <= steps.x(); ++column) {
            const Eigen::Vector2d xy = box.min() + size / 2 + spacing * (Eigen::Vector2d(column, row) - steps / 2);
            const auto on_edge = [&](const job::Polygon& polygon) {
                return job::distance_to_edge(polygon, xy) < kEdgeToleranceSpacings * spacing;
            };
            const bool outside_anomaly = !job::contains(both.anomaly, xy) || on_edge(both.anomaly);
            if (outside_anomaly && (job::contains(outer, xy) || on_edge(outer))) places.push_back(xy);
        }
    return job::rotation_working_machine(job.theta).transpose() * job::columns_to_matrix(places);
}

HillClimbResult hill_climb(Eigen::Index candidates, const SubsetError& error, const HillClimbOptions& options)
{
    if (candidates < std::max<Eigen::Index>(options.touches, 1))
        throw core::InputError("there are " + std::to_string(candidates) + " candidates for " +
                               std::to_string(options.touches) + " touches: place them closer to each other");
    return HillClimber(candidates, error, options).run();
}

TouchPlan make_touch_plan(const job::Job& job, const Eigen::Matrix2Xd& chosen)
{
    const job::Boundaries both = job::working_boundaries(job);
    const Eigen::Matrix2Xd working = job::rotation_working_machine(job.theta) * chosen;
    std::vector<Role> roles;
    for (Eigen::Index i = 0; i < working.cols(); ++i)
        roles.push_back(job::distance_to_edge(both.anomaly, working.col(i)) <=
                                job::distance_to_edge(both.sampling, working.col(i))
                            ? Role::near_anomaly
                            : Role::near_sampling_boundary);
    TouchPlan plan;
    append_line(plan, working, job.theta, kNoLine, roles);
    return plan;
}

} // namespace fettle::sampling
