#pragma once

#include "core/constants.h"
#include "find/bounds.h"

#include <Eigen/Core>

#include <array>

namespace fettle::find {

/// Quantities that distinguish an anomaly from a feature of the part, measured on one candidate. Lengths mm unless they
/// say otherwise.
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
    double ring_width = 0;     ///< cells, as far as metal was there
    double cells = 0;          ///< number
    double thickness = 0;      ///< largest inscribed circle's diameter, cells
    double cell = 1;           ///< mm
    double degree = 1;         ///< of the surface
    /// Of its top from a plane: departure_from_plane(). Infinite: not measured, as of what is hardly an anomaly anyway.
    double top_departure = core::kInfinity;

    /// Standard deviation of the surface beneath: of the mean of the metal around it, and of the surface itself.
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

/// What a flat top takes from that score: it is more often a feature by design. 0 if its departure is not measured.
double flat_top_score(const Evidence& evidence);

/// Least score of a doubtful find: what is below is hardly an anomaly.
inline constexpr double kMinDoubtfulScore = -4.1;

/// Whether a find of this score may be a feature of the part as well as an anomaly, or is rather one.
bool is_doubtful(double score);

/// Share of finds that are features by design, however sure the evidence: of a kind that no part had to which the
/// probabilities were fitted.
inline constexpr double kUnforeseenShare = 0.005;

/// Probability that a find is an anomaly, at most 1 - kUnforeseenShare. A part that shows many doubtful finds has
/// features of its own of that kind.
/// @param doubtful_others  doubtful finds beside it, in the same view
double probability_of(double score, int doubtful_others);

/// Probability that a departure from a reference is an anomaly. The reference has the part's own features, so that
/// significance and height over the noise suffice.
double probability_against(const Evidence& evidence);

/// Whether the evidence is worth a probability at all: bounds far outside of what anomalies of the evaluation set show.
/// @param bounds  of heights
bool is_plausible(const Evidence& evidence, const SearchBounds& bounds);

} // namespace fettle::find
