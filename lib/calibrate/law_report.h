#pragma once

#include "calibrate/law_record.h"

namespace fettle::calibrate {

/// How well a parameter is determined: "measured" if its standard deviation is at most 0.05 (level) or 0.1 (exponents,
/// and the wear as a share of its mean), "weakly" if it is at most half of that before the first pass, "assumed" if it
/// is larger, or its factor was the same in all passes, "not recorded".
std::string determination(const LearntLaw& law, Parameter parameter);

/// Pairs of parameters that could not be told apart: both uncertain, and correlated by more than 0.9.
struct IndistinctPair {
    Parameter first, second;
    double correlation;
};
std::vector<IndistinctPair> indistinct_pairs(const LearntLaw& law);

/// Conditions of the pass that would tell most: each factor at the least or the greatest of the passes so far, or
/// 1.5 times beyond if they had but one.
removal::RemovalTrial most_informative_pass(const LearntLaw& law);

/// How well the passes were predicted, from the first that was judged on.
struct PredictionQuality {
    std::size_t judged = 0, covered = 0, changes = 0;
    double median_error = 0; ///< relative
};
PredictionQuality prediction_quality(const LearntLaw& law);

/// Numbers about the last run that a law was learnt from: passes, known (before it), judged, covered, changes,
/// median_error, and the relative standard deviation of what is expected of the next pass.
json::Value run_report(LearntLaw law, std::size_t known_passes, const removal::RemovalTrial& next);

/// The law: mean, covariance, determination of each parameter, indistinct pairs, the next pass, the quality, changes.
json::Value to_json(const LearntLaw& law);

} // namespace fettle::calibrate
