#include "removal/removal_fit.h"

#include "core/decompositions.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fettle::removal {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Work of the belt up to the middle of the trial.
double mid_trial_work(const RemovalTrial& trial)
{
    const double work = trial.force * trial.speed * trial.duration;
    return trial.prior_work + (std::isnan(work) ? 0 : work / 2);
}

struct Factor {
    double RemovalTrial::*value;
    double RemovalLaw::*exponent;
    double preston_exponent;
};

/// The recorded factors besides the force. A trial with a feed has no duration of its own.
std::vector<Factor> recorded_factors(const std::vector<RemovalTrial>& trials)
{
    const Factor candidates[] = {{&RemovalTrial::speed, &RemovalLaw::speed_exponent, 1},
                                 {&RemovalTrial::feed, &RemovalLaw::feed_exponent, -1},
                                 {&RemovalTrial::duration, &RemovalLaw::duration_exponent, 1}};
    std::vector<Factor> recorded;
    for (const Factor& factor : candidates)
        if (std::none_of(trials.begin(), trials.end(), [&](const auto& t) { return std::isnan(t.*factor.value); }))
            recorded.push_back(factor);
    return recorded;
}

void check(const std::vector<RemovalTrial>& trials, const std::vector<Factor>& factors)
{
    for (std::size_t k = 0; k < trials.size(); ++k) {
        bool positive = trials[k].force > 0 && trials[k].volume > 0 && trials[k].prior_work >= 0;
        for (const Factor& factor : factors) positive = positive && trials[k].*factor.value > 0;
        if (!positive) throw core::InputError("trial " + std::to_string(k) + ": a value is not positive");
    }
}

/// Unit that makes the wear of order 1 in the equations.
double wear_unit(const std::vector<RemovalTrial>& trials)
{
    double max_work = 0;
    for (const RemovalTrial& trial : trials) max_work = std::max(max_work, mid_trial_work(trial));
    return max_work > 0 ? 1 / max_work : 1;
}

struct Solution {
    RemovalLaw law;
    double cost = 0;
};

/// Solves for all parameters but the threshold, in which alone the logarithm is not linear.
Solution solve(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms, double threshold)
{
    const std::vector<Factor> factors = recorded_factors(trials);
    const Index exponents = terms.exponents ? factors.size() + 1 : 0, count = trials.size();
    const double unit = wear_unit(trials);
    Eigen::MatrixXd A(count, 1 + exponents + (terms.wear ? 1 : 0));
    VectorXd b(count);
    for (Index i = 0; i < count; ++i) {
        const RemovalTrial& trial = trials[i];
        b[i] = std::log(trial.volume);
        A(i, 0) = 1;
        Index column = 1;
        const auto add_factor = [&](double value, double preston_exponent) {
            if (terms.exponents)
                A(i, column++) = std::log(value);
            else
                b[i] -= preston_exponent * std::log(value);
        };
        add_factor(trial.force - threshold, 1);
        for (const Factor& recorded : factors) add_factor(trial.*recorded.value, recorded.preston_exponent);
        if (terms.wear) A(i, column) = -mid_trial_work(trial) * unit;
    }
    const core::LeastSquaresSolution best = core::least_squares_by_qr(A, b);
    if (terms.wear && best.x[A.cols() - 1] < 0)
        return solve(trials, {terms.exponents, false, terms.threshold}, threshold);
    Solution solution;
    RemovalLaw& law = solution.law;
    law.threshold = threshold;
    law.log_coefficient = best.x[0];
    law.force_exponent = terms.exponents ? best.x[1] : 1;
    for (std::size_t k = 0; k < factors.size(); ++k)
        law.*factors[k].exponent = terms.exponents ? best.x[2 + k] : factors[k].preston_exponent;
    law.wear_rate = terms.wear ? best.x[A.cols() - 1] * unit : 0;
    solution.cost = (A * best.x - b).squaredNorm();
    return solution;
}

/// Scans a hundred thresholds below the smallest force, since that one cut something, then refines the best by
/// bisection.
Solution solve_with_threshold(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms)
{
    constexpr int kThresholdSteps = 100, kBisections = 40;
    const double min_force = std::ranges::min(trials, {}, &RemovalTrial::force).force;
    const double step = min_force / kThresholdSteps;
    double best = 0;
    Solution solution = solve(trials, terms, 0);
    const auto try_threshold = [&](double threshold) {
        if (threshold < 0 || threshold >= min_force) return;
        const Solution candidate = solve(trials, terms, threshold);
        if (candidate.cost < solution.cost) {
            solution = candidate;
            best = threshold;
        }
    };
    for (int k = 1; k < kThresholdSteps; ++k) try_threshold(k * step);
    double offset = step / 2;
    for (int k = 0; k < kBisections; ++k, offset /= 2) {
        const double center = best;
        try_threshold(center - offset);
        try_threshold(center + offset);
    }
    return solution;
}

} // namespace

double removed_volume(const RemovalLaw& law, const RemovalTrial& trial)
{
    if (!(trial.force > law.threshold)) return 0;
    const auto power = [](double value, double exponent) { return exponent == 0 ? 1 : std::pow(value, exponent); };
    return std::exp(law.log_coefficient - law.wear_rate * mid_trial_work(trial)) *
           power(trial.force - law.threshold, law.force_exponent) * power(trial.speed, law.speed_exponent) *
           power(trial.feed, law.feed_exponent) * power(trial.duration, law.duration_exponent);
}

RemovalLaw fit_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms)
{
    const std::vector<Factor> factors = recorded_factors(trials);
    const std::size_t unknowns =
        1 + (terms.exponents ? 1 + factors.size() : 0) + (terms.wear ? 1 : 0) + (terms.threshold ? 1 : 0);
    if (trials.size() < unknowns)
        throw core::InputError(std::to_string(trials.size()) + " trials for " + std::to_string(unknowns) + " unknowns");
    check(trials, factors);
    return (terms.threshold ? solve_with_threshold(trials, terms) : solve(trials, terms, 0)).law;
}

RemovalScore score_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms)
{
    RemovalScore score;
    score.law = fit_removal(trials, terms);
    double mean = 0, spread = 0, fitted = 0, left_out = 0, max_error = 0;
    for (const RemovalTrial& trial : trials) mean += std::log(trial.volume) / trials.size();
    for (std::size_t k = 0; k < trials.size(); ++k) {
        std::vector<RemovalTrial> others = trials;
        others.erase(others.begin() + k);
        const auto log_error = [&](const RemovalLaw& law) {
            return std::log(trials[k].volume / removed_volume(law, trials[k]));
        };
        const double with = log_error(score.law), without = log_error(fit_removal(others, terms));
        spread += std::pow(std::log(trials[k].volume) - mean, 2);
        fitted += with * with;
        left_out += without * without;
        max_error = std::max(max_error, std::abs(without));
    }
    score.r2 = 1 - fitted / spread;
    score.leave_one_out_r2 = 1 - left_out / spread;
    score.worst_factor = std::exp(max_error);
    return score;
}

} // namespace fettle::removal
