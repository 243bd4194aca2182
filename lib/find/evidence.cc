#include "find/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::find {
namespace {

// Variance of the mean height of a region as a share of the ring's variance: neighbouring cells are correlated.
constexpr double kMeanVariance = 0.35;
constexpr double kMinNoiseShare = 0.5; // of the noise: a ring quieter than that is chance

constexpr double kMinSeen = 0.05; // share of the shell that is seen, in ratios to it

// Logarithms of ratios grow without bound where a ring is perfect; they are limited to this.
constexpr double kMaxLogRatio = 4.5;
constexpr double kMinRatio = 1e-3, kMaxRatio = 1e4; // limits of the ratios, so that the logarithm is finite
// Lower bounds of the spreads that a height is divided by, as shares of the ring's, or of the noise: smaller ones are
// chance.
constexpr double kMinDisagreementShare = 0.3, kMinTextureShare = 0.3, kMinSagShare = 0.1, kMinInstabilityShare = 0.1;
constexpr double kMaxRoundness = 6; // cells over the square of the thickness: a disc has 0.8, a bead of six widths 6
// Divisors that bring a feature to about 1, as the weights' penalty expects.
constexpr double kDegreeScale = 4, kLogCellsScale = 5, kRoundnessScale = 3;

// A candidate outside these is not measured further: they exclude what no anomaly of the training scans came near.
constexpr double kMinPlausibleSignificance = 4, kMinPlausibleRingSds = 2.5, kMinPlausibleDisagreements = 2; // heights
constexpr double kMinPlausibleThickness = 3;                                                                // cells
constexpr double kMaxPlausibleDrop = 0.6, kMaxPlausibleRise = 0.4;
constexpr double kMinPlausibleInliers = 0.35, kMinPlausibleEnclosure = 0.2, kMinPlausibleEnclosureOrUnseen = 0.35;

/// weight · min(feature, knot).
struct Term {
    int feature;
    double knot;
    double weight;
};

constexpr double kNoKnot = std::numeric_limits<double>::infinity();

// The model, from pipelines/programs/find-train.cc; docs/methods/find.md describes the training set.
constexpr Term kModelTerms[] = {
#include "find/weights.inc"
};

// Calibration of the log odds by the score and by the doubtful finds of the view: on parts that were left out of the
// fit, the share of right finds equals the probability (pipelines/programs/find-calibration.cc).
constexpr double kCalibrationSlope = 1.6, kCalibrationOffset = 2.4, kCalibrationOthers = -0.6;
// Scores from kMinDoubtfulScore to this one are probabilities of .02 to .58, if no other find of the view is doubtful.
constexpr double kMaxDoubtfulScore = -1.3;

// The height of an anomaly is seldom more than exp(2.5), twelve times, the departure of its top from a plane; that of
// features by design is. Each factor of e above that lowers the score: by more if the top is level, as bosses are, than
// if it leans, as a stub may where a saw went through it (docs/methods/find.md).
constexpr double kFlatTopKnot = 2.5, kLevelTopScore = 4, kLeaningTopScore = 1;
// A level top rises over its thickness by this share of its height, or by noise, at most.
constexpr double kLevelRise = 0.02;

// Against a reference: slope and offset of the log odds by the height in standard deviations, which is centred and
// scaled by the second pair.
constexpr double kReferenceSlope = 1.06, kReferenceOffset = 1.38;
constexpr double kReferenceCentre = 6, kReferenceScale = 1;

double logistic(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

double log_ratio(double a, double b)
{
    return std::min(std::log(std::clamp(a / b, kMinRatio, kMaxRatio)), kMaxLogRatio);
}

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
    f << 1, log_ratio(e.height, e.ring_sd),
        log_ratio(e.height, std::max(e.disagreement, kMinDisagreementShare * e.ring_sd)), e.enclosure / seen, e.inliers,
        e.drop / seen, e.rise / seen, std::log(std::clamp(e.ring_sd / e.noise, 1.0, kMaxRatio)),
        log_ratio(e.height, std::max(e.texture, kMinTextureShare * e.noise)), e.degree / kDegreeScale, e.sharpness,
        e.pits, std::log(e.cells) / kLogCellsScale,
        std::min(e.cells / (e.thickness * e.thickness), kMaxRoundness) / kRoundnessScale, e.unseen,
        std::min(std::log(e.significance()), kMaxLogRatio),
        log_ratio(e.height, std::max(e.instability, kMinInstabilityShare * e.ring_sd)),
        log_ratio(e.height, std::max(e.sag, kMinSagShare * e.ring_sd)), log_ratio(e.height, e.thickness * e.cell),
        log_ratio(e.height, e.noise);
    return f;
}

double score_of(const Evidence& evidence)
{
    const Features features = features_of(evidence);
    double score = 0;
    for (const Term& term : kModelTerms) score += term.weight * std::min(features[term.feature], term.knot);
    return score;
}

double flat_top_score(const Evidence& evidence)
{
    const double flatness = log_ratio(evidence.height, std::max(evidence.top_departure, evidence.noise));
    const bool is_level = evidence.top_rise <= std::hypot(kLevelRise * evidence.height, evidence.noise);
    return (is_level ? kLevelTopScore : kLeaningTopScore) * std::max(flatness - kFlatTopKnot, 0.0);
}

bool is_doubtful(double score) { return score >= kMinDoubtfulScore && score < kMaxDoubtfulScore; }

double probability_of(double score, int doubtful_others)
{
    const double log_odds =
        kCalibrationSlope * score + kCalibrationOffset + kCalibrationOthers * std::log1p(doubtful_others);
    return (1 - kUnforeseenShare) * logistic(log_odds);
}

double probability_against(const Evidence& e)
{
    const double height_in_sds = std::min(e.significance(), e.height / e.noise);
    return logistic(kReferenceSlope * (height_in_sds - kReferenceCentre) / kReferenceScale + kReferenceOffset);
}

bool is_plausible(const Evidence& e, const SearchBounds& bounds)
{
    return e.height < bounds.max_height && e.height >= bounds.min_height &&
           e.significance() > kMinPlausibleSignificance && e.height > kMinPlausibleRingSds * e.ring_sd &&
           e.height > kMinPlausibleDisagreements * e.disagreement && e.thickness >= kMinPlausibleThickness &&
           e.drop < kMaxPlausibleDrop && e.rise < kMaxPlausibleRise && e.inliers > kMinPlausibleInliers &&
           e.enclosure + e.unseen > kMinPlausibleEnclosureOrUnseen && e.enclosure > kMinPlausibleEnclosure;
}

} // namespace fettle::find
