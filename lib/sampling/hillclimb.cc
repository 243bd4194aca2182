#include "sampling/hillclimb.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace fettle {

namespace {

constexpr int kMostCandidates = 100000;
// Of the spacing: so near to an edge rounding does not put a candidate on its other side. Boundary points lie on good
// metal.
constexpr double kOnEdge = 1e-6;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Subset = std::vector<Eigen::Index>;

/// A subset of the candidates on its way.
class Climber {
  public:
    Climber(Eigen::Index candidates, const SubsetError& error, const HillClimb& options)
        : count_(candidates), error_(error), options_(options), random_(options.seed)
    {
    }

    HillClimbed run()
    {
        start();
        for (int i = 0; i < options_.mutations; ++i) mutate();
        best_ = current_;
        discard();
        if (options_.touches > 0) {
            chosen_best_ = inside_;
            best_ = current_;
            for (int i = 0; i < kExchanges * options_.mutations; ++i) exchange();
            inside_ = chosen_best_;
            current_ = best_;
        }
        if (!std::isfinite(current_))
            throw InputError("no subset of the candidates that was tried covers the anomaly: more touches or a wider "
                             "sampling boundary are needed");
        std::ranges::sort(inside_);
        return {inside_, current_, start_error_, evaluations_};
    }

  private:
    /// Uniform in [0, 1), the same on every platform.
    double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }

    double error_of(Subset subset)
    {
        ++evaluations_;
        std::ranges::sort(subset);
        const double error = error_(subset);
        return std::isnan(error) ? kInfinite : error;
    }

    void start()
    {
        Subset order(static_cast<std::size_t>(count_));
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[below(i)]);
        const auto half = std::max(order.size() / 2, static_cast<std::size_t>(options_.touches));
        inside_.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half));
        outside_.assign(order.begin() + static_cast<std::ptrdiff_t>(half), order.end());
        start_error_ = current_ = error_of(inside_);
    }

    static void move(Subset& from, std::size_t which, Subset& to)
    {
        to.push_back(from[which]);
        from[which] = from.back();
        from.pop_back();
    }

    /// One candidate changes sides, unless too few would be left.
    void mutate()
    {
        const std::size_t which = below(static_cast<std::size_t>(count_));
        const bool leaves = which < inside_.size();
        if (leaves && inside_.size() <= std::max<std::size_t>(static_cast<std::size_t>(options_.touches), 1)) return;
        Subset& from = leaves ? inside_ : outside_;
        Subset& to = leaves ? outside_ : inside_;
        move(from, leaves ? which : which - inside_.size(), to);
        const double error = error_of(inside_);
        if (error <= current_)
            current_ = error;
        else
            move(to, to.size() - 1, from);
    }

    /// With probability exp(-k max(error - best, 0)); a random number is drawn for what is worse only.
    bool accepted(double error)
    {
        if (error <= best_) return true;
        if (!std::isfinite(error)) return false;
        return uniform() < std::exp(-options_.sharpness * (error - best_));
    }

    void discard()
    {
        Subset refused;
        Eigen::Index cheapest = -1;
        double least = kInfinite;
        const auto wanted = static_cast<std::size_t>(options_.touches);
        // Members that were refused since the last discard lie at the end, behind `open`.
        std::size_t open = inside_.size();
        while (inside_.size() > std::max<std::size_t>(wanted, 1)) {
            if (open == 0) {
                if (wanted == 0) return; // each was refused
                const auto which = cheapest < 0 ? below(inside_.size()) : static_cast<std::size_t>(cheapest);
                leave_out(which, least);
            } else {
                const std::size_t which = below(open);
                Subset fewer = inside_;
                fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(which));
                const double error = error_of(fewer);
                if (accepted(error)) {
                    leave_out(which, error);
                } else {
                    std::swap(inside_[which], inside_[--open]);
                    if (error < least) {
                        least = error;
                        cheapest = static_cast<Eigen::Index>(open);
                    }
                    continue;
                }
            }
            open = inside_.size();
            cheapest = -1;
            least = kInfinite;
        }
    }

    void leave_out(std::size_t which, double error)
    {
        move(inside_, which, outside_);
        current_ = error;
        best_ = std::min(best_, error);
    }

    /// One inside for one outside.
    void exchange()
    {
        if (outside_.empty()) return;
        const std::size_t in = below(inside_.size()), out = below(outside_.size());
        std::swap(inside_[in], outside_[out]);
        const double error = error_of(inside_);
        if (!accepted(error)) {
            std::swap(inside_[in], outside_[out]);
            return;
        }
        current_ = error;
        if (error < best_) {
            best_ = error;
            chosen_best_ = inside_;
        }
    }

    Eigen::Index count_;
    const SubsetError& error_;
    HillClimb options_;
    std::mt19937_64 random_;
    Subset inside_, outside_, chosen_best_;
    double current_ = kInfinite, best_ = kInfinite, start_error_ = kInfinite;
    int evaluations_ = 0;
};

} // namespace

Eigen::Matrix2Xd candidate_touches(const Job& job, double spacing)
{
    const Boundaries both = boundaries(job);
    const Polygon& outer = both.sampling;
    if (spacing <= 0) spacing = std::sqrt((area(outer) - area(both.anomaly)) / kCandidates);
    const Eigen::Vector2d least = outer.rowwise().minCoeff(), size = outer.rowwise().maxCoeff() - least;
    const Eigen::Vector2d steps = (size / spacing).array().floor();
    if ((steps.array() + 1).prod() > kMostCandidates)
        throw InputError("a spacing of " + to_short_text(spacing / job.units.mm()) + " " + to_string(job.units.length) +
                         " gives more than " + std::to_string(kMostCandidates) + " candidates");
    std::vector<Eigen::Vector2d> places;
    for (double row = 0; row <= steps.y(); ++row)
        for (double column = 0; column <= steps.x(); ++column) {
            const Eigen::Vector2d xy = least + size / 2 + spacing * (Eigen::Vector2d(column, row) - steps / 2);
            const auto on_edge = [&](const Polygon& polygon) {
                return distance_to_edge(polygon, xy) < kOnEdge * spacing;
            };
            const bool good_metal = !contains(both.anomaly, xy) || on_edge(both.anomaly);
            if (good_metal && (contains(outer, xy) || on_edge(outer))) places.push_back(xy);
        }
    Eigen::Matrix2Xd working(2, static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) working.col(static_cast<Eigen::Index>(i)) = places[i];
    return rotation_working_machine(job.theta).transpose() * working;
}

HillClimbed hill_climb(Eigen::Index candidates, const SubsetError& error, const HillClimb& options)
{
    if (candidates < std::max<Eigen::Index>(options.touches, 1))
        throw InputError("there are " + std::to_string(candidates) + " candidates for " +
                         std::to_string(options.touches) + " touches: place them closer to each other");
    return Climber(candidates, error, options).run();
}

TouchPlan plan_of(const Job& job, const Eigen::Matrix2Xd& chosen)
{
    const Boundaries both = boundaries(job);
    const Eigen::Matrix2Xd working = rotation_working_machine(job.theta) * chosen;
    std::vector<Role> roles;
    for (Eigen::Index i = 0; i < working.cols(); ++i)
        roles.push_back(distance_to_edge(both.anomaly, working.col(i)) <=
                                distance_to_edge(both.sampling, working.col(i))
                            ? Role::near_anomaly
                            : Role::near_sampling_boundary);
    TouchPlan plan;
    append_line(plan, working, job.theta, -1, roles);
    return plan;
}

} // namespace fettle
