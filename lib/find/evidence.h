#pragma once

#include "core/constants.h"
#include "find/bounds.h"

#include <Eigen/Core>

#include <array>

namespace fettle::find {

/// Quantities that distinguish an anomaly from a feature of the part, measured on one candidate. Lengths are in mm
/// unless stated otherwise.
struct Evidence {
    double height = 0;        ///< 0.9 quantile over the surface beneath
    double ring_sd = 0;       ///< of the metal around, about that surface
    double prediction_sd = 0; ///< of the surface itself beneath the candidate, median
    double disagreement = 0;  ///< between surfaces from the whole ring and from its inner half, 0.75 quantile
    double instability =
        0;          ///< root mean square change of the surface as each quadrant of the ring is left out, 0.75 quantile
    double sag = 0; ///< of the surface beneath the candidate: standard deviation from its own plane
    double noise = 0;          ///< of the map
    double texture = 0;        ///< of the sheet's residual at the candidate's scale
    double enclosure = 0;      ///< share of a shell around it that lies on the surface
    double drop = 0, rise = 0; ///< share of that shell far beneath, and above it
    double unseen = 0;         ///< share of that shell where nothing is seen
    double inliers = 0;        ///< share of the ring on the surface
    double pits = 0;           ///< share of the ring far beneath
    double sharpness = 0;      ///< share of the height within two cells inside and outside of the boundary
    double ring_width = 0;     ///< cells, up to the outermost metal
    double cells = 0;          ///< number
    double thickness = 0;      ///< largest inscribed circle's diameter, cells
    double cell = 1;           ///< mm
    double degree = 1;         ///< of the surface
    /// Departure of its top from a plane, measure_top(). Infinite: not measured, as for improbable candidates.
    double top_departure = core::kInfinity;
    double top_rise = 0; ///< of that plane against the surface beneath, over the thickness

    /// Standard deviation of the surface beneath, from the scatter of the metal around and the variance of the fit.
    double surface_sd() const;
    double significance() const { return height / surface_sd(); }
};

inline constexpr int kFeatures = 20;
using Features = Eigen::Matrix<double, kFeatures, 1>;

/// Features of the logistic model; the first is 1.
Features features_of(const Evidence& evidence);

/// Score of the candidate by its own evidence, which rises with the probability that it is an anomaly: a linear model
/// of features_of(), whose weights and their origin docs/methods/find.md describes.
double score_of(const Evidence& evidence);

/// Decrease of that score by a flat top, which is more often a feature by design. 0 if its departure is not measured.
double flat_top_score(const Evidence& evidence);

/// Minimum score of a doubtful find: a candidate below it is hardly an anomaly.
inline constexpr double kMinDoubtfulScore = -4.1;

/// Whether a find of this score may as well be a feature of the part.
bool is_doubtful(double score);

/// Share of finds that are features by design in spite of strong evidence: of a kind that the parts of the calibration
/// did not have.
inline constexpr double kUnforeseenShare = 0.005;

/// Probability that a find is an anomaly, at most 1 - kUnforeseenShare. A part that shows many doubtful finds has
/// features of its own of that kind.
/// @param doubtful_others  doubtful finds beside it, in the same view
double probability_of(double score, int doubtful_others);

/// Probability that a departure from a reference is an anomaly. The reference has the part's own features, so that
/// significance and height over the noise suffice.
double probability_against(const Evidence& evidence);

/// Whether the evidence lies within bounds, which are wide beside those of the evaluation set's anomalies.
/// @param bounds  of heights
bool is_plausible(const Evidence& evidence, const SearchBounds& bounds);

} // namespace fettle::find
