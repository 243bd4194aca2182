#include "find/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::find {
namespace {

// Share of the ring's variance that the height of a region's mean has: neighbouring cells are correlated.
constexpr double kMeanVariance = 0.35;
constexpr double kMinNoiseShare = 0.5; // of the noise: a ring quieter than that is chance

constexpr double kMinSeen = 0.05; // share of the shell that is seen, in ratios to it

// Logarithms of ratios grow without end where a ring is perfect; beyond this they say no more.
constexpr double kMaxLogRatio = 4.5;

/// weight · min(feature, knot).
struct Term {
    int feature;
    double knot;
    double weight;
};

constexpr double kNoKnot = std::numeric_limits<double>::infinity();

// The model, made by pipelines/programs/find-train.cc; docs/methods/find.md says from what.
constexpr Term kTerms[] = {
#include "find/weights.inc"
};

// Against a reference: standard deviations at which chance and anomaly are as probable, and over which that changes.
constexpr double kEvenStanding = 6, kStandingScale = 1;

double log_ratio(double a, double b) { return std::min(std::log(std::clamp(a / b, 1e-3, 1e4)), kMaxLogRatio); }

} // namespace

double Evidence::surface_sd() const
{
    const double ring = std::max(ring_sd, kMinNoiseShare * noise);
    return std::sqrt(kMeanVariance * ring * ring + prediction_sd * prediction_sd);
}

Features features_of(const Evidence& e)
{
    const double seen = std::max(1 - e.unseen, kMinSeen);
    Features f;
    f << 1, log_ratio(e.height, e.ring_sd), log_ratio(e.height, std::max(e.disagreement, 0.3 * e.ring_sd)),
        e.enclosure / seen, e.inliers, e.drop / seen, e.rise / seen,
        std::log(std::clamp(e.ring_sd / e.noise, 1.0, 1e4)), log_ratio(e.height, std::max(e.texture, 0.3 * e.noise)),
        e.degree / 4, e.sharpness, e.pits, std::log(e.cells) / 5,
        std::min(e.cells / (e.thickness * e.thickness), 6.0) / 3, e.unseen,
        std::min(std::log(e.significance()), kMaxLogRatio),
        log_ratio(e.height, std::max(e.instability, 0.1 * e.ring_sd)),
        log_ratio(e.height, std::max(e.sag, 0.1 * e.ring_sd)), log_ratio(e.height, e.thickness * e.cell),
        log_ratio(e.height, e.noise);
    return f;
}

double probability_of(const Evidence& evidence)
{
    const Features features = features_of(evidence);
    double score = 0;
    for (const Term& term : kTerms) score += term.weight * std::min(features[term.feature], term.knot);
    return 1 / (1 + std::exp(-score));
}

double probability_against(const Evidence& e)
{
    const double standing = std::min(e.significance(), e.height / e.noise);
    return 1 / (1 + std::exp((kEvenStanding - standing) / kStandingScale));
}

bool is_plausible(const Evidence& e, const SearchBounds& bounds)
{
    return e.height < bounds.max_height && e.height >= bounds.min_height && e.significance() > 4 &&
           e.height > 2.5 * e.ring_sd && e.height > 2 * e.disagreement && e.thickness >= 3 && e.drop < 0.6 &&
           e.rise < 0.4 && e.inliers > 0.35 && e.enclosure + e.unseen > 0.35 && e.enclosure > 0.2;
}

} // namespace fettle::find
