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

constexpr std::array<double, kFeatures> kWeights{-10.8, -0.21, 2.29, 2.96, 0.40, 0.33, -0.04, -2.30, 0.16,
                                                 -0.31, 3.20,  -0.26, 0.41, -0.10, 0, 0};

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
        std::min(std::log(e.significance()), kMaxLogRatio);
    return f;
}

double probability_of(const Evidence& evidence)
{
    return 1 / (1 + std::exp(-features_of(evidence).dot(Eigen::Map<const Features>(kWeights.data()))));
}

bool is_plausible(const Evidence& e, double max_height)
{
    return e.height < max_height && e.significance() > 4 && e.height > 2.5 * e.ring_sd &&
           e.height > 2 * e.disagreement && e.thickness >= 3 && e.drop < 0.6 && e.rise < 0.4 && e.inliers > 0.35 &&
           e.enclosure + e.unseen > 0.35 && e.enclosure > 0.2;
}

} // namespace fettle::find
