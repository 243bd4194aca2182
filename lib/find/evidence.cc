#include "find/evidence.h"

#include <algorithm>
#include <cmath>

namespace fettle::find {
namespace {

// Share of the ring's variance that the height of a region's mean has: neighbouring cells are correlated.
constexpr double kMeanVariance = 0.35;
constexpr double kMinNoiseShare = 0.5; // of the noise: a ring quieter than that is chance

// Logarithms of ratios grow without end where a ring is perfect; beyond this they say no more.
constexpr double kMaxLogRatio = 4.5;

// Weights of the features, made by pipelines/programs/find-train.cc (docs/methods/find.md says from what).
constexpr std::array<double, kFeatures> kWeights{
    -10.722, // constant
    0.111,   // height over the ring's scatter
    0.484,   // height over the disagreement of whole and inner ring
    4.399,   // enclosure
    0.750,   // inliers
    -1.682,  // drop
    -18.792, // rise
    -0.451,  // the ring's scatter over the noise
    0.000,   // height over the sheet's texture
    0.000,   // degree of the surface
    1.400,   // sharpness
    -1.528,  // pits
    0.000,   // number of cells
    -0.539,  // cells over thickness²
    -5.340,  // unseen
    0.795,   // significance
    0.299,   // height over instability
    0.115,   // height over sag
    -0.219,  // height over thickness
    0.051,   // height over the noise
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
    Features f;
    f << 1, log_ratio(e.height, e.ring_sd), log_ratio(e.height, std::max(e.disagreement, 0.3 * e.ring_sd)), e.enclosure,
        e.inliers, e.drop, e.rise, std::log(std::clamp(e.ring_sd / e.noise, 1.0, 1e4)),
        log_ratio(e.height, std::max(e.texture, 0.3 * e.noise)), e.degree / 4, e.sharpness, e.pits,
        std::log(e.cells) / 5, std::min(e.cells / (e.thickness * e.thickness), 6.0) / 3, e.unseen,
        std::min(std::log(e.significance()), kMaxLogRatio),
        log_ratio(e.height, std::max(e.instability, 0.1 * e.ring_sd)), log_ratio(e.height, std::max(e.sag, 0.1 * e.ring_sd)),
        log_ratio(e.height, e.thickness * e.cell), log_ratio(e.height, e.noise);
    return f;
}

double probability_of(const Evidence& evidence)
{
    return 1 / (1 + std::exp(-features_of(evidence).dot(Eigen::Map<const Features>(kWeights.data()))));
}

double probability_against(const Evidence& e)
{
    const double standing = std::min(e.significance(), e.height / e.noise);
    return 1 / (1 + std::exp((kEvenStanding - standing) / kStandingScale));
}

bool is_plausible(const Evidence& e, double max_height)
{
    return e.height < max_height && e.significance() > 4 && e.height > 2.5 * e.ring_sd &&
           e.height > 2 * e.disagreement && e.thickness >= 3 && e.drop < 0.6 && e.rise < 0.4 && e.inliers > 0.35 &&
           e.enclosure + e.unseen > 0.35 && e.enclosure > 0.2;
}

} // namespace fettle::find
