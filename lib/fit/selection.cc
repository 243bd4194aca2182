#include "fit/selection.h"

#include "fit/bspline.h"
#include "fit/family.h"
#include "fit/plane.h"
#include "fit/process.h"
#include "fit/trimmed_touches.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::fit {

namespace {

// A surface with less than this share of the largest weight changes the mean by less than the probe's resolution.
constexpr double kMinRelativeWeight = 1e-3;

const FitCandidate* best_of(const std::vector<FitCandidate>& candidates)
{
    const FitCandidate* best = nullptr;
    for (const FitCandidate& candidate : candidates)
        if (candidate.converged && (best == nullptr || candidate.score < best->score)) best = &candidate;
    return best;
}

/// True if the touches agree with a family, so that no other explanation is needed.
bool is_sufficient(const FitCandidate* best, Eigen::Index touches)
{
    constexpr double kMinGoodness = 0.05; // p-value
    // A family with almost as many parameters as touches fits anything.
    return best != nullptr && best->outliers.empty() && 2 * best->freedom >= touches &&
           chi2_p_value(best->chi2, best->freedom) >= kMinGoodness;
}

void fit_families(const TouchSet& touches, const std::vector<std::string>& names, const TouchIndices& kept,
                  std::vector<FitCandidate>& candidates)
{
    std::vector<std::optional<FitCandidate>> fitted(names.size());
    tbb::parallel_for(std::size_t{0}, names.size(),
                      [&](std::size_t k) { fitted[k] = fit_family(names[k], touches, kept); });
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::string& name = names[k];
        std::optional<FitCandidate>& candidate = fitted[k];
        if (!candidate || !candidate->converged) continue;
        candidate->score += prior_penalty(name);
        const auto same = std::find_if(candidates.begin(), candidates.end(),
                                       [&](const FitCandidate& other) { return other.method == name; });
        if (same == candidates.end())
            candidates.push_back(std::move(*candidate));
        else if (candidate->score < same->score)
            *same = std::move(*candidate);
    }
}

/// Replaces Schwarz's penalty of the parameters that a rare family has more than a common one. That penalty, ln n per
/// parameter, belongs to a unit-information prior: the information of one of the n touches, so heights of the size of
/// the touch error. The terms of a rare family may be larger, so their prior is given the variance g (in units of that
/// from all touches) that maximises the likelihood, but at least n (Liang et al. 2008, "Mixtures of g priors", 2.4).
/// Otherwise a cubic, say, would be penalised less than the process, whose penalty grows with its amplitude.
void penalise_rare_families(std::vector<FitCandidate>& candidates, Eigen::Index touches)
{
    const double n = touches;
    const auto parameters = [&](const FitCandidate& c) { return n - c.outliers.size() - c.freedom; };
    for (FitCandidate& rare : candidates) {
        if (!is_rare(rare.method)) continue;
        const double schwarz = rare.score;
        double min_score = std::numeric_limits<double>::infinity();
        for (const FitCandidate& common : candidates) {
            const double more = parameters(rare) - parameters(common);
            if (is_rare(common.method) || more <= 0) continue;
            const double explained = std::max(0.0, common.score - prior_penalty(common.method) -
                                                       (schwarz - prior_penalty(rare.method)) + more * std::log(n));
            const double g = std::max(n, explained / more - 1);
            min_score =
                std::min(min_score, schwarz - more * std::log(n) + more * std::log(1 + g) + explained / (1 + g));
        }
        if (std::isfinite(min_score)) rare.score = min_score;
    }
}

} // namespace

bool is_rare(const std::string& family)
{
    return family == "cone" || family == "torus" || family == "cubic" || family == "swept";
}

double prior_penalty(const std::string& family)
{
    constexpr double kPriorRatio = 4, kCubicRatio = 10;
    if (family == "cubic") return 2 * std::log(kCubicRatio);
    return is_rare(family) || family == "quadratic" || family == "gp" ? 2 * std::log(kPriorRatio) : 0;
}

std::vector<std::string> candidate_families(job::SurfaceType type)
{
    if (type == job::SurfaceType::swept) return {"plane", "cylinder", "swept"};
    return {"plane", "sphere", "cylinder", "cone", "torus", "ellipsoid", "quadratic", "cubic"};
}

void set_candidates(std::vector<WeightedCandidate> candidates, surface::Surface& surface)
{
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const WeightedCandidate& a, const WeightedCandidate& b) { return a.weight > b.weight; });
    const double max_weight = candidates.front().weight;
    double sum = 0;
    for (WeightedCandidate& candidate : candidates) {
        if (candidate.weight < kMinRelativeWeight * max_weight) candidate.weight = 0;
        sum += candidate.weight;
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        FitCandidate& candidate = candidates[i].candidate;
        const double weight = candidates[i].weight / sum;
        if (i == 0) {
            surface.method = candidate.method;
            surface.shape = std::move(candidate.shape);
            surface.covariance = std::move(candidate.covariance);
            surface.outliers = candidate.outliers;
            surface.score = candidate.score;
            surface.weight = weight;
        } else if (weight > 0) {
            surface.alternatives.push_back({candidate.method, candidate.score, weight, std::move(candidate.shape),
                                            std::move(candidate.covariance)});
        } else {
            surface.alternatives.push_back({candidate.method, candidate.score, 0, {}, {}});
        }
    }
}

Fit fit_auto(const FitInput& input)
{
    if (input.job.surface == job::SurfaceType::plane) return fit_plane(input);
    // Fewer touches are fitted by any of the families.
    const int min_touches = input.job.surface == job::SurfaceType::swept ? 5 : 6;
    surface::Surface surface = begin_surface(input, job::to_string(input.job.surface), kSampleRoles, min_touches);
    const TouchSet touches = make_touch_set(surface, input.job);
    const std::vector<std::string> names = candidate_families(input.job.surface);
    std::vector<FitCandidate> candidates;
    fit_families(touches, names, all_touches(touches), candidates);
    const Eigen::Index n = touches.xyz.cols();
    // With estimated noise a process fits any touches.
    const bool may_be_process = input.job.surface == job::SurfaceType::freeform && !input.estimate_noise;
    const auto process = [&] { return fit_gaussian_process(touches, spline_grid(input, surface.touches)); };
    std::optional<FitCandidate> smooth;
    const bool seems_sufficient = is_sufficient(best_of(candidates), n);
    if (!seems_sufficient) // then a process is needed, unless the touches of a family were hidden by outliers
        tbb::parallel_invoke([&] { fit_families(touches, names, trimmed_touches(touches), candidates); },
                             [&] { smooth = may_be_process ? process() : std::nullopt; });
    penalise_rare_families(candidates, n);
    // A rare family also fits some surfaces that belong to no family.
    const FitCandidate* best = best_of(candidates);
    if (may_be_process && (!is_sufficient(best, n) || is_rare(best->method))) {
        if (seems_sufficient) smooth = process();
        if (smooth) {
            smooth->score += prior_penalty(smooth->method);
            candidates.push_back(std::move(*smooth));
        }
    }
    if (candidates.empty()) refuse_undetermined(touches, surface.method + " surface", input.source);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const FitCandidate& a, const FitCandidate& b) { return a.score < b.score; });
    const double freedom_of_all = candidates.front().freedom + candidates.front().outliers.size();
    const int iterations = candidates.front().iterations;
    std::vector<WeightedCandidate> weighted;
    const double best_score = candidates.front().score;
    for (FitCandidate& candidate : candidates) {
        const double weight = std::exp((best_score - candidate.score) / 2);
        weighted.push_back({std::move(candidate), weight});
    }
    set_candidates(std::move(weighted), surface);
    return finish_fit(std::move(surface), freedom_of_all, true, iterations);
}

} // namespace fettle::fit
