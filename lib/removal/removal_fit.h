#pragma once

#include <vector>

namespace fettle::removal {

/// A measured trial: the wheel pressed on the part at rest, or moved over it once. A quantity that was not recorded is
/// NaN in all trials.
struct RemovalTrial {
    double force = 0;      ///< N
    double speed = 0;      ///< of the belt, in any unit that is the same in all trials
    double feed = 0;       ///< mm/s
    double duration = 0;   ///< s
    double prior_work = 0; ///< work that the belt did before: sum of force · speed · duration
    double volume = 0;     ///< removed, mm³
    double deviation = 0;  ///< standard deviation of the volume's logarithm by its measurement alone
};

/// Terms of a law that are fitted besides its coefficient.
struct RemovalTerms {
    bool exponents = true; ///< false: those of Preston, force · speed · duration or force · speed / feed
    bool wear = true;
    bool threshold = false;
};

/// volume = exp(log_coefficient) · (F - threshold)^force · V_b^speed · V_w^feed · t^duration · exp(-wear · W), with W
/// the belt's work at the middle of the trial. The exponent of a quantity that was not recorded is 0.
struct RemovalLaw {
    double log_coefficient = 0;
    double force_exponent = 1, speed_exponent = 0, feed_exponent = 0, duration_exponent = 0; ///< exponents
    double threshold = 0;                                                                    ///< N
    double wear_rate = 0; ///< 1 / (work after which the removal rate has fallen to 1/e), ≥ 0
};

/// Volume that the law predicts for a trial, mm³.
double removed_volume(const RemovalLaw& law, const RemovalTrial& trial);

/// Fits a law by least squares in the logarithm of the volume. Negative wear is replaced by 0, since a belt does not
/// sharpen.
/// @throws InputError for fewer trials than unknowns, or a value that is not positive
RemovalLaw fit_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms);

/// Quality of a law in the logarithm of the volume: R² = 1 - Σ(log V - log predicted)² / Σ(log V - mean)².
struct RemovalScore {
    RemovalLaw law; ///< fitted to all trials
    double r2 = 0;  ///< of `law`
    double leave_one_out_r2 =
        0;                   ///< leave-one-out: each trial predicted from the others; the mean is that of all trials
    double worst_factor = 0; ///< max. ratio of a leave-one-out prediction to the measured volume or its inverse; ≥ 1
};
/// Fits a law and cross-validates it.
/// @throws InputError as fit_removal(), also without one of the trials
RemovalScore score_removal(const std::vector<RemovalTrial>& trials, const RemovalTerms& terms);

} // namespace fettle::removal
