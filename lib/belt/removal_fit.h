#pragma once

#include <vector>

namespace fettle {

/// What a belt removed in one measured trial: the wheel pressed on and held for a while, or led over the part once. A
/// value that was not recorded is NaN in all trials.
struct RemovalTrial {
    double force = 0;    ///< N
    double speed = 0;    ///< of the belt, in any unit
    double feed = 0;     ///< mm/s
    double duration = 0; ///< s
    double worn = 0;     ///< work of the belt before: force · speed · duration, summed over all that it did
    double volume = 0;   ///< mm³
};

/// What a law may say besides its coefficient.
struct RemovalTerms {
    bool exponents = true; ///< otherwise Preston's: force · speed · duration, or force · speed / feed
    bool wear = true;
    bool threshold = false;
};

/// volume = exp(log_coefficient) · (F - threshold)^force · V_b^speed · V_w^feed · t^duration · exp(-wear · W), with W
/// the belt's work at the middle of the trial. The exponent of what was not recorded is 0.
struct RemovalLaw {
    double log_coefficient = 0;
    double force = 1, speed = 0, feed = 0, duration = 0;
    double threshold = 0; ///< N
    double wear = 0;      ///< 1 / the work after which the belt cuts 1/e as fast, ≥ 0
};

/// Of a trial, mm³.
double removed_volume(const RemovalLaw& law, const RemovalTrial& trial);

/// Least squares in the volume's logarithm. A belt does not sharpen: where wear would be negative it is 0.
/// @throws InputError for fewer trials than unknowns, or a value that is not positive
RemovalLaw fit_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms);

/// How well a law tells the volume's logarithm: R² = 1 - Σ(log V - log predicted)² / Σ(log V - mean)².
struct RemovalScore {
    RemovalLaw law;          ///< of all trials
    double r2 = 0;           ///< of it
    double left_out_r2 = 0;  ///< each trial predicted by the law of the others; the mean is that of all
    double worst_factor = 0; ///< of such a prediction, to the volume measured, or the other way around; ≥ 1
};
RemovalScore score_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms);

} // namespace fettle
