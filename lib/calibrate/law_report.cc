#include "calibrate/law_report.h"

#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::calibrate {
namespace {

using removal::RemovalTrial;

/// Factors that differ by less were meant to be the same, and say nothing of the exponent.
constexpr double kMinRatio = 1.02;

struct Bounds {
    double min = 0, max = 0;
    bool vary() const { return max > kMinRatio * min; }
};

Bounds bounds_of(const LearntLaw& law, double RemovalTrial::*value)
{
    Bounds bounds{std::numeric_limits<double>::infinity(), 0};
    for (const JudgedPass& judged : law.passes) {
        const auto add = [&](const RemovalTrial& trial) {
            bounds.min = std::min(bounds.min, trial.*value);
            bounds.max = std::max(bounds.max, trial.*value);
        };
        add(judged.pass);
        for (const RemovalTrial& part : judged.parts) add(part);
    }
    return bounds;
}

json::Value conditions(const RemovalTrial& trial)
{
    json::Value value;
    for (const Factor& factor : kFactors)
        if (!std::isnan(trial.*factor.value)) value.set(kParameterNames[factor.parameter], trial.*factor.value);
    return value;
}

json::Value changes(const LearntLaw& law)
{
    std::vector<json::Value> list;
    for (std::size_t k = 0; k < law.passes.size(); ++k) {
        const JudgedPass& judged = law.passes[k];
        if (judged.has_change)
            list.push_back(json::Value()
                               .set("pass", k + 1)
                               .set("volume", judged.pass.volume)
                               .set("lower", judged.predicted.lower)
                               .set("upper", judged.predicted.upper)
                               .set("probability", judged.predicted.tail_probability));
    }
    return list;
}

} // namespace

std::string determination(const LearntLaw& law, Parameter parameter)
{
    constexpr double kMeasuredLevel = 0.05, kMeasuredExponent = 0.1, kWeaklyShare = 0.5;
    const RemovalTrial& reference = law.belief.reference();
    if (!is_recorded(reference, parameter)) return "not recorded";
    for (const Factor& factor : kFactors)
        if (factor.parameter == parameter && !bounds_of(law, factor.value).vary()) return "assumed";
    const Posterior posterior = law.belief.posterior(),
                    prior = LawBelief(reference, law.belief.pass_work()).posterior();
    const double deviation = std::sqrt(posterior.covariance(parameter, parameter)),
                 before = std::sqrt(prior.covariance(parameter, parameter));
    const double measured = parameter == level  ? kMeasuredLevel
                            : parameter == wear ? kMeasuredExponent * std::abs(posterior.mean[wear])
                                                : kMeasuredExponent;
    if (deviation <= measured) return "measured";
    return deviation <= kWeaklyShare * before ? "weakly" : "assumed";
}

std::vector<IndistinctPair> indistinct_pairs(const LearntLaw& law)
{
    constexpr double kMinCorrelation = 0.9;
    const ParameterMatrix covariance = law.belief.posterior().covariance;
    std::vector<IndistinctPair> pairs;
    for (Eigen::Index i = 0; i < parameter_count; ++i)
        for (Eigen::Index j = i + 1; j < parameter_count; ++j) {
            if (!is_recorded(law.belief.reference(), Parameter(i)) ||
                !is_recorded(law.belief.reference(), Parameter(j)))
                continue;
            const double product = covariance(i, i) * covariance(j, j);
            const double correlation = product > 0 ? covariance(i, j) / std::sqrt(product) : 0;
            const bool both_known =
                determination(law, Parameter(i)) == "measured" && determination(law, Parameter(j)) == "measured";
            if (std::abs(correlation) > kMinCorrelation && !both_known)
                pairs.push_back({Parameter(i), Parameter(j), correlation});
        }
    return pairs;
}

RemovalTrial most_informative_pass(const LearntLaw& law)
{
    constexpr double kBeyond = 1.5;
    std::vector<RemovalTrial> candidates{law.passes.back().pass};
    for (const Factor& factor : kFactors) {
        if (!is_recorded(law.belief.reference(), factor.parameter)) continue;
        Bounds bounds = bounds_of(law, factor.value);
        if (!bounds.vary()) bounds = {bounds.min / kBeyond, bounds.max * kBeyond};
        std::vector<RemovalTrial> both;
        for (RemovalTrial candidate : candidates)
            for (const double value : {bounds.min, bounds.max}) {
                candidate.*factor.value = value;
                both.push_back(candidate);
            }
        candidates = both;
    }
    return *std::ranges::max_element(candidates, {}, [&](const auto& c) { return law.belief.information(c); });
}

PredictionQuality prediction_quality(const LearntLaw& law)
{
    PredictionQuality quality;
    std::vector<double> errors;
    for (const JudgedPass& judged : law.passes) {
        if (!judged.is_judged) continue;
        const double volume = judged.pass.volume;
        errors.push_back(std::abs(judged.predicted.volume / volume - 1));
        quality.covered += judged.predicted.lower <= volume && volume <= judged.predicted.upper ? 1 : 0;
        quality.changes += judged.has_change ? 1 : 0;
    }
    quality.judged = errors.size();
    const std::size_t upper = errors.size() / 2, lower = (errors.size() - 1) / 2;
    quality.median_error = errors.empty()
                               ? std::numeric_limits<double>::quiet_NaN()
                               : (geometry::nth_smallest(errors, lower) + geometry::nth_smallest(errors, upper)) / 2;
    return quality;
}

json::Value run_report(LearntLaw law, std::size_t known_passes, const RemovalTrial& next)
{
    const Prediction expected = law.belief.predict(next, std::erf(std::sqrt(0.5))); // one standard deviation
    law.passes.erase(law.passes.begin(), law.passes.begin() + std::ptrdiff_t(known_passes));
    const PredictionQuality quality = prediction_quality(law);
    return json::Value()
        .set("passes", law.passes.size())
        .set("known", known_passes)
        .set("judged", quality.judged)
        .set("covered", quality.covered)
        .set("changes", quality.changes)
        .set("median_error", quality.median_error)
        .set("spread", (expected.upper - expected.lower) / (2 * expected.volume));
}

json::Value to_json(const LearntLaw& law)
{
    const Posterior posterior = law.belief.posterior();
    std::vector<json::Value> parameters, pairs;
    for (Eigen::Index k = 0; k < parameter_count; ++k)
        parameters.push_back(json::Value()
                                 .set("name", kParameterNames[k])
                                 .set("mean", posterior.mean[k])
                                 .set("sigma", std::sqrt(posterior.covariance(k, k)))
                                 .set("determined", determination(law, Parameter(k))));
    for (const IndistinctPair& pair : indistinct_pairs(law))
        pairs.push_back(json::Value()
                            .set("first", kParameterNames[pair.first])
                            .set("second", kParameterNames[pair.second])
                            .set("correlation", pair.correlation));
    const PredictionQuality quality = prediction_quality(law);
    const RemovalTrial next = most_informative_pass(law);
    return json::Value()
        .set("passes", law.passes.size())
        .set("reference", conditions(law.belief.reference()))
        .set("parameters", parameters)
        .set("covariance", Eigen::MatrixXd(posterior.covariance))
        .set("scatter", posterior.scatter)
        .set("drift", posterior.drift)
        .set("heavy_tails", posterior.heavy_tails)
        .set("indistinct", pairs)
        .set("next_pass", conditions(next))
        .set("next_information", law.belief.information(next))
        .set("judged", quality.judged)
        .set("covered", quality.covered)
        .set("median_error", quality.median_error)
        .set("changes", changes(law));
}

} // namespace fettle::calibrate
