#include "fit/selection.h"

#include "fit/bspline.h"
#include "fit/family.h"
#include "fit/plane.h"
#include "fit/process.h"
#include "fit/trimmed_touches.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

// A surface that is less probable moves the mean by less than the probe sees.
constexpr double kLeastWeight = 1e-3;

/// −2 ln of how rare a family is beforehand. Castings are mostly planes, cylinders, spheres and what bends like a
/// quadratic; cones, tori and surfaces (sections) of changing curvature count as four times rarer. Without it, sixteen
/// touches follow their own noise into one of those in one case of twenty.
double rarity(const std::string& family)
{
    constexpr double kRarer = 4;
    return family == "cone" || family == "torus" || family == "cubic" || family == "swept" ? 2 * std::log(kRarer) : 0;
}

std::vector<std::string> names_for(SurfaceType type)
{
    if (type == SurfaceType::swept) return {"plane", "cylinder", "swept"};
    return {"plane", "sphere", "cylinder", "cone", "torus", "quadratic", "cubic"};
}

const Candidate* best_of(const std::vector<Candidate>& candidates)
{
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates)
        if (candidate.converged && (best == nullptr || candidate.score < best->score)) best = &candidate;
    return best;
}

/// Do the touches leave nothing to explain?
bool explains(const Candidate* best, Eigen::Index touches)
{
    // One set of touches in twenty of a surface of the family looks worse.
    constexpr double kLeastGoodness = 0.05;
    // A family with almost as many parameters as touches explains anything.
    return best != nullptr && best->gross_errors.empty() && 2 * best->freedom >= static_cast<double>(touches) &&
           goodness(best->chi2, best->freedom) >= kLeastGoodness;
}

void fit_families(const Touched& touched, const std::vector<std::string>& names, const Columns& kept,
                  std::vector<Candidate>& candidates)
{
    for (const std::string& name : names) {
        std::optional<Candidate> candidate = fit_family(name, touched, kept);
        if (!candidate || !candidate->converged) continue;
        candidate->score += rarity(name);
        const auto same = std::find_if(candidates.begin(), candidates.end(),
                                       [&](const Candidate& other) { return other.method == name; });
        if (same == candidates.end())
            candidates.push_back(std::move(*candidate));
        else if (candidate->score < same->score)
            *same = std::move(*candidate);
    }
}

/// Schwarz's price of a parameter, ln n, stands for the prior that one touch of n would make of it: heights of the size
/// of the touch error. What a rare family adds to the nearest common one is larger than that if it explains more; its
/// prior is given the width g (in units of that of all touches) that makes the touches most probable, but at least n
/// (Liang et al. 2008, "Mixtures of g priors", 2.4). Else a cubic, say, would cost less than the process, whose price
/// grows with its amplitude.
void charge_rare_families(std::vector<Candidate>& candidates, Eigen::Index touches)
{
    const auto n = static_cast<double>(touches);
    const auto parameters = [&](const Candidate& c) {
        return n - static_cast<double>(c.gross_errors.size()) - c.freedom;
    };
    for (Candidate& rare : candidates) {
        if (rarity(rare.method) == 0) continue;
        const double schwarz = rare.score;
        double least = std::numeric_limits<double>::infinity();
        for (const Candidate& common : candidates) {
            const double more = parameters(rare) - parameters(common);
            if (rarity(common.method) > 0 || more <= 0) continue;
            const double explained = std::max(0.0, common.score - (schwarz - rarity(rare.method)) + more * std::log(n));
            const double g = std::max(n, explained / more - 1);
            least = std::min(least, schwarz - more * std::log(n) + more * std::log(1 + g) + explained / (1 + g));
        }
        if (std::isfinite(least)) rare.score = least;
    }
}

/// Takes the candidates over as the surface and its alternatives.
void weigh(std::vector<Candidate>& candidates, Surface& surface)
{
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
    double sum = 0;
    std::vector<double> weights;
    for (const Candidate& candidate : candidates) {
        const double weight = std::exp((candidates.front().score - candidate.score) / 2);
        weights.push_back(weight < kLeastWeight ? 0 : weight);
        sum += weights.back();
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        Candidate& candidate = candidates[i];
        if (i == 0) {
            surface.method = candidate.method;
            surface.shape = std::move(candidate.shape);
            surface.covariance = std::move(candidate.covariance);
            surface.gross_errors = candidate.gross_errors;
            surface.score = candidate.score;
            surface.weight = weights[0] / sum;
        } else if (weights[i] > 0) {
            surface.alternatives.push_back({candidate.method, candidate.score, weights[i] / sum,
                                            std::move(candidate.shape), std::move(candidate.covariance)});
        } else {
            surface.alternatives.push_back({candidate.method, candidate.score, 0, {}, {}});
        }
    }
}

} // namespace

Fit fit_auto(const FitInput& input)
{
    if (input.job.surface == SurfaceType::plane) return fit_plane(input);
    // Fewer are explained by anything.
    const int least = input.job.surface == SurfaceType::swept ? 5 : 6;
    Surface surface = begin_surface(input, to_string(input.job.surface), kSampleRoles, least);
    const Touched touched = touched_of(surface, input.job);
    const std::vector<std::string> names = names_for(input.job.surface);
    std::vector<Candidate> candidates;
    fit_families(touched, names, all_touches(touched), candidates);
    const Eigen::Index n = touched.xyz.cols();
    if (!explains(best_of(candidates), n)) fit_families(touched, names, trimmed_touches(touched), candidates);
    charge_rare_families(candidates, n);
    // A rare family also explains some touches of surfaces that are of no family, noise that is not known all of them.
    const Candidate* best = best_of(candidates);
    if (input.job.surface == SurfaceType::freeform && !input.estimate_noise &&
        (!explains(best, n) || rarity(best->method) > 0))
        if (std::optional<Candidate> smooth = fit_process(touched, spline_grid(input, surface.touches)))
            candidates.push_back(std::move(*smooth));
    if (candidates.empty()) refuse_undetermined(touched, surface.method + " surface", input.source);
    weigh(candidates, surface);
    const Candidate& chosen = candidates.front();
    const double all = chosen.freedom + static_cast<double>(chosen.gross_errors.size());
    return finish_fit(std::move(surface), all, true, chosen.iterations);
}

} // namespace fettle
