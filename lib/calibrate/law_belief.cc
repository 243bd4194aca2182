#include "calibrate/law_belief.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace fettle::calibrate {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using removal::RemovalTrial;

/// Student's t has tails that outliers fit in with few, and a finite variance with more than two.
constexpr double kDegreesOfFreedom = 4;

/// Standard deviations before the first pass. The level may be anything. Published exponents of the force and the speed
/// of belts are from 0.7 to 2.3. Time adds up: its exponent, and the feed's, differ from Preston's by the run-in alone.
constexpr double kLevelDeviation = 5, kForceDeviation = 1, kSpeedDeviation = 1, kTimeDeviation = 0.3;
/// A belt or a wheel lasts some hundreds of passes, and does not sharpen: the wear is two deviations from none.
constexpr double kWear = 1.0 / 300, kWearDeviation = kWear / 2;
/// Scatter from a laboratory's to one beyond which no law is of use.
constexpr double kScatters[] = {0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64};
/// A level that wanders is the exception, and must show itself.
constexpr struct {
    double deviation, prior;
} kDrifts[] = {{0, 1}, {0.06, 0.01}, {0.2, 0.01}};
/// Loosened: a factor of 2 is one standard deviation.
constexpr double kLoosenedDeviation = std::numbers::ln2;

double log_density(double error, double variance, bool has_heavy_tails)
{
    const double z2 = error * error / variance;
    if (!has_heavy_tails) return -0.5 * (z2 + std::log(2 * std::numbers::pi * variance));
    const double nu = kDegreesOfFreedom;
    return std::lgamma((nu + 1) / 2) - std::lgamma(nu / 2) - 0.5 * std::log(nu * std::numbers::pi * variance) -
           (nu + 1) / 2 * std::log1p(z2 / nu);
}

/// Distribution function of the normal distribution, or of Student's t with 4 degrees of freedom in closed form.
double cumulative(double z, bool has_heavy_tails)
{
    if (!has_heavy_tails) return 0.5 * std::erfc(-z / std::numbers::sqrt2);
    const double r = 1 + z * z / 4;
    return 0.5 + 3.0 / 8 * z / std::sqrt(r) * (1 - z * z / r / 12);
}

void check(const RemovalTrial& reference, const RemovalTrial& trial)
{
    for (const Factor& factor : kFactors)
        if (!std::isnan(reference.*factor.value) && !(trial.*factor.value > 0))
            throw core::InputError(std::string("the ") + kParameterNames[factor.parameter] +
                                   " of a pass is not positive");
    if (!(trial.prior_work >= 0)) throw core::InputError("the work before a pass is negative or unknown");
}

/// A normal or t component of a predictive distribution.
struct Component {
    double weight, center, deviation;
    bool has_heavy_tails;
};

double mixture_cumulative(const std::vector<Component>& mixture, double y)
{
    double sum = 0;
    for (const Component& c : mixture) sum += c.weight * cumulative((y - c.center) / c.deviation, c.has_heavy_tails);
    return sum;
}

double mixture_quantile(const std::vector<Component>& mixture, double probability)
{
    // All that double's logarithms can hold; sixty halvings end at the rounding of y.
    double lower = -700, upper = 700;
    constexpr int kBisections = 60;
    for (int k = 0; k < kBisections; ++k) {
        const double middle = (lower + upper) / 2;
        (mixture_cumulative(mixture, middle) < probability ? lower : upper) = middle;
    }
    return (lower + upper) / 2;
}

} // namespace

Parameters preston_exponents()
{
    Parameters exponents = Parameters::Zero();
    for (const Factor& factor : kFactors) exponents[factor.parameter] = factor.preston_exponent;
    return exponents;
}

bool is_recorded(const RemovalTrial& reference, Parameter parameter)
{
    return std::ranges::none_of(kFactors, [&](const Factor& factor) {
        return factor.parameter == parameter && std::isnan(reference.*factor.value);
    });
}

LawBelief::LawBelief(const RemovalTrial& reference, double pass_work) : reference_(reference), pass_work_(pass_work)
{
    check(reference, reference);
    if (!(pass_work > 0)) throw core::InputError("the work of a pass is not positive");
    using FreeSet = std::array<bool, parameter_count>;
    std::vector<FreeSet> sets;
    const auto add = [&](const std::vector<Parameter>& exponents) {
        FreeSet set{};
        set[level] = set[wear] = true;
        for (const Parameter parameter : exponents) set[parameter] = is_recorded(reference, parameter);
        if (std::ranges::find(sets, set) == sets.end()) sets.push_back(set);
    };
    add({});
    add({force});
    add({force, feed, duration});
    add({force, speed, feed, duration});

    Parameters deviation;
    deviation << kLevelDeviation, kForceDeviation, kSpeedDeviation, kTimeDeviation, kTimeDeviation, kWearDeviation;
    for (const FreeSet& set : sets)
        for (const double scatter : kScatters)
            for (const auto& drift : kDrifts)
                for (const bool has_heavy_tails : {false, true}) {
                    LawModel& model = models_.emplace_back();
                    model.is_free = set;
                    model.scatter = scatter;
                    model.drift = drift.deviation;
                    model.has_heavy_tails = has_heavy_tails;
                    model.log_score = std::log(drift.prior);
                    model.mean = preston_exponents();
                    model.mean[wear] = kWear;
                    for (Index k = 0; k < parameter_count; ++k)
                        model.covariance(k, k) = set[k] ? deviation[k] * deviation[k] : 0;
                }
}

Parameters LawBelief::regressors(const RemovalTrial& trial) const
{
    Parameters x = Parameters::Zero();
    x[level] = 1;
    for (const Factor& factor : kFactors)
        if (is_recorded(reference_, factor.parameter))
            x[factor.parameter] = std::log(trial.*factor.value / reference_.*factor.value);
    x[wear] = -trial.prior_work / pass_work_;
    return x;
}

VectorXd LawBelief::weights() const
{
    VectorXd weights(models_.size());
    for (Index k = 0; k < weights.size(); ++k) weights[k] = models_[k].log_score;
    weights = (weights.array() - weights.maxCoeff()).exp();
    return weights / weights.sum();
}

Prediction LawBelief::predict(const RemovalTrial& next, double probability) const
{
    check(reference_, next);
    const Parameters x = regressors(next);
    const VectorXd weight = weights();
    constexpr double kMinWeight = 1e-9; // of a model; all lighter ones together change no digit that is shown
    std::vector<Component> mixture;
    for (Index k = 0; k < weight.size(); ++k) {
        const LawModel& model = models_[k];
        if (weight[k] < kMinWeight) continue;
        const double variance = x.dot(model.covariance * x) + model.drift * model.drift + model.scatter * model.scatter;
        mixture.push_back({weight[k], x.dot(model.mean), std::sqrt(variance), model.has_heavy_tails});
    }
    Prediction prediction;
    prediction.volume = std::exp(mixture_quantile(mixture, 0.5));
    prediction.lower = std::exp(mixture_quantile(mixture, (1 - probability) / 2));
    prediction.upper = std::exp(mixture_quantile(mixture, (1 + probability) / 2));
    if (next.volume > 0) {
        prediction.volume_share = mixture_cumulative(mixture, std::log(next.volume));
        prediction.tail_probability = 2 * std::min(prediction.volume_share, 1 - prediction.volume_share);
    }
    return prediction;
}

void LawBelief::update(const std::vector<RemovalTrial>& parts)
{
    for (const RemovalTrial& part : parts) {
        check(reference_, part);
        if (!(part.volume > 0)) throw core::InputError("the volume of a pass is not positive");
    }
    for (LawModel& model : models_) model.covariance(level, level) += model.drift * model.drift;
    for (const RemovalTrial& part : parts) observe(part);
}

void LawBelief::observe(const RemovalTrial& part)
{
    const Parameters x = regressors(part);
    const double y = std::log(part.volume);
    for (LawModel& model : models_) {
        const Parameters Px = model.covariance * x;
        const double noise = model.scatter * model.scatter + part.deviation * part.deviation,
                     error = y - x.dot(model.mean);
        double variance = x.dot(Px) + noise;
        model.log_score += log_density(error, variance, model.has_heavy_tails);
        if (model.has_heavy_tails) {
            const double weight = (kDegreesOfFreedom + 1) / (kDegreesOfFreedom + error * error / variance);
            variance = x.dot(Px) + noise / weight;
        }
        model.mean += Px * (error / variance);
        model.covariance -= Px * Px.transpose() / variance;
    }
}

void LawBelief::loosen_level()
{
    for (LawModel& model : models_) model.covariance(level, level) += kLoosenedDeviation * kLoosenedDeviation;
}

Posterior LawBelief::posterior() const
{
    Posterior posterior;
    const VectorXd weight = weights();
    for (Index k = 0; k < weight.size(); ++k) {
        posterior.mean += weight[k] * models_[k].mean;
        posterior.scatter += weight[k] * models_[k].scatter;
        posterior.drift += weight[k] * models_[k].drift;
        posterior.heavy_tails += models_[k].has_heavy_tails ? weight[k] : 0;
    }
    for (Index k = 0; k < weight.size(); ++k) {
        const Parameters offset = models_[k].mean - posterior.mean;
        posterior.covariance += weight[k] * (models_[k].covariance + offset * offset.transpose());
    }
    return posterior;
}

double LawBelief::information(const RemovalTrial& next) const
{
    check(reference_, next);
    const Parameters x = regressors(next);
    const Posterior known = posterior();
    return x.dot(known.covariance * x) / (known.scatter * known.scatter);
}

} // namespace fettle::calibrate
