#include "belt/removal_fit.h"

#include "core/decompositions.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

double middle_of_work(const RemovalTrial& trial)
{
    const double own = trial.force * trial.speed * trial.duration;
    return trial.worn + (std::isnan(own) ? 0 : own / 2);
}

struct Factor {
    double RemovalTrial::*value;
    double RemovalLaw::*exponent;
    double prestons; ///< the exponent of Preston's law
};

/// Those besides the force that were recorded. A trial that has a feed lasts as long as its way takes.
std::vector<Factor> recorded_factors(const std::vector<RemovalTrial>& trials)
{
    const Factor all[] = {{&RemovalTrial::speed, &RemovalLaw::speed, 1},
                          {&RemovalTrial::feed, &RemovalLaw::feed, -1},
                          {&RemovalTrial::duration, &RemovalLaw::duration, 1}};
    std::vector<Factor> recorded;
    for (const Factor& factor : all)
        if (std::none_of(trials.begin(), trials.end(), [&](const auto& t) { return std::isnan(t.*factor.value); }))
            recorded.push_back(factor);
    return recorded;
}

void check(const std::vector<RemovalTrial>& trials, const std::vector<Factor>& factors)
{
    for (std::size_t k = 0; k < trials.size(); ++k) {
        bool positive = trials[k].force > 0 && trials[k].volume > 0 && trials[k].worn >= 0;
        for (const Factor& factor : factors) positive = positive && trials[k].*factor.value > 0;
        if (!positive) throw InputError("trial " + std::to_string(k) + ": a value is not positive");
    }
}

/// Wear that numbers of the order of 1 stand for.
double unit_of_wear(const std::vector<RemovalTrial>& trials)
{
    double most = 0;
    for (const RemovalTrial& trial : trials) most = std::max(most, middle_of_work(trial));
    return most > 0 ? 1 / most : 1;
}

struct Solution {
    RemovalLaw law;
    double cost = 0;
};

/// The logarithm is linear in all but the threshold.
Solution solve(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms, double threshold)
{
    const std::vector<Factor> factors = recorded_factors(trials);
    const auto free = static_cast<Index>(terms.exponents ? factors.size() + 1 : 0);
    const auto count = static_cast<Index>(trials.size());
    const double unit = unit_of_wear(trials);
    Eigen::MatrixXd A(count, 1 + free + (terms.wear ? 1 : 0));
    VectorXd b(count);
    for (Index i = 0; i < count; ++i) {
        const RemovalTrial& trial = trials[static_cast<std::size_t>(i)];
        b[i] = std::log(trial.volume);
        A(i, 0) = 1;
        Index column = 1;
        const auto factor = [&](double value, double prestons) {
            if (terms.exponents)
                A(i, column++) = std::log(value);
            else
                b[i] -= prestons * std::log(value);
        };
        factor(trial.force - threshold, 1);
        for (const Factor& at : factors) factor(trial.*at.value, at.prestons);
        if (terms.wear) A(i, column) = -middle_of_work(trial) * unit;
    }
    const LeastSquares best = least_squares_by_qr(A, b);
    if (terms.wear && best.x[A.cols() - 1] < 0)
        return solve(trials, {terms.exponents, false, terms.threshold}, threshold);
    Solution solution;
    RemovalLaw& law = solution.law;
    law.threshold = threshold;
    law.log_coefficient = best.x[0];
    law.force = terms.exponents ? best.x[1] : 1;
    for (std::size_t k = 0; k < factors.size(); ++k)
        law.*factors[k].exponent = terms.exponents ? best.x[2 + static_cast<Index>(k)] : factors[k].prestons;
    law.wear = terms.wear ? best.x[A.cols() - 1] * unit : 0;
    solution.cost = (A * best.x - b).squaredNorm();
    return solution;
}

double least_force(const std::vector<RemovalTrial>& trials)
{
    double least = trials.front().force;
    for (const RemovalTrial& trial : trials) least = std::min(least, trial.force);
    return least;
}

/// The best of a hundred thresholds below the least force that cut something, then between its neighbours.
Solution solve_with_threshold(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms)
{
    constexpr int kSteps = 100, kHalvings = 40;
    const double step = least_force(trials) / kSteps;
    double best = 0;
    Solution found = solve(trials, terms, 0);
    const auto try_at = [&](double threshold) {
        if (threshold < 0 || threshold >= least_force(trials)) return;
        const Solution other = solve(trials, terms, threshold);
        if (other.cost < found.cost) {
            found = other;
            best = threshold;
        }
    };
    for (int k = 1; k < kSteps; ++k) try_at(k * step);
    double beside = step / 2;
    for (int k = 0; k < kHalvings; ++k, beside /= 2) {
        const double from = best;
        try_at(from - beside);
        try_at(from + beside);
    }
    return found;
}

} // namespace

double removed_volume(const RemovalLaw& law, const RemovalTrial& trial)
{
    if (!(trial.force > law.threshold)) return 0;
    const auto power = [](double value, double exponent) { return exponent == 0 ? 1 : std::pow(value, exponent); };
    return std::exp(law.log_coefficient - law.wear * middle_of_work(trial)) *
           power(trial.force - law.threshold, law.force) * power(trial.speed, law.speed) * power(trial.feed, law.feed) *
           power(trial.duration, law.duration);
}

RemovalLaw fit_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms)
{
    const std::vector<Factor> factors = recorded_factors(trials);
    const std::size_t unknowns =
        1 + (terms.exponents ? 1 + factors.size() : 0) + (terms.wear ? 1 : 0) + (terms.threshold ? 1 : 0);
    if (trials.size() < unknowns)
        throw InputError(std::to_string(trials.size()) + " trials for " + std::to_string(unknowns) + " unknowns");
    check(trials, factors);
    return (terms.threshold ? solve_with_threshold(trials, terms) : solve(trials, terms, 0)).law;
}

RemovalScore score_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms)
{
    RemovalScore score;
    score.law = fit_removal(trials, terms);
    double mean = 0, spread = 0, fitted = 0, left_out = 0, worst = 0;
    for (const RemovalTrial& trial : trials) mean += std::log(trial.volume) / static_cast<double>(trials.size());
    for (std::size_t k = 0; k < trials.size(); ++k) {
        std::vector<RemovalTrial> others = trials;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        const auto miss = [&](const RemovalLaw& law) {
            return std::log(trials[k].volume / removed_volume(law, trials[k]));
        };
        const double with = miss(score.law), without = miss(fit_removal(others, terms));
        spread += std::pow(std::log(trials[k].volume) - mean, 2);
        fitted += with * with;
        left_out += without * without;
        worst = std::max(worst, std::abs(without));
    }
    score.r2 = 1 - fitted / spread;
    score.left_out_r2 = 1 - left_out / spread;
    score.worst_factor = std::exp(worst);
    return score;
}

} // namespace fettle
