#include "fit/leave_one_out.h"

#include <cmath>
#include <numbers>

namespace fettle::fit {

Eigen::Index most_probable_outlier(const LeaveOneOut& predictions, double log_outlier)
{
    Eigen::Index worst = -1;
    double best_gain = 0;
    for (Eigen::Index i = 0; i < predictions.deviation.rows(); ++i) {
        const Eigen::ArrayXd deviation = predictions.deviation.row(i), variance = predictions.variance.row(i);
        const Eigen::ArrayXd log_weight = predictions.log_weight.row(i);
        Eigen::ArrayXd weight = (log_weight - log_weight.maxCoeff()).exp();
        weight /= weight.sum();
        const double mean = (weight * deviation).sum();
        const double total = (weight * (variance + (deviation - mean).square())).sum(); // within and between models
        if (!(mean * mean > kMinOutlierDeviations * kMinOutlierDeviations * total)) continue;
        // ln of the mixture's density, by its largest term, which rounding cannot lose
        const Eigen::ArrayXd log_terms =
            weight.log() - (deviation.square() / variance + variance.log() + std::log(2 * std::numbers::pi)) / 2;
        const double max = log_terms.maxCoeff();
        const double gain = log_outlier - max - std::log((log_terms - max).exp().sum());
        if (gain > best_gain) {
            best_gain = gain;
            worst = i;
        }
    }
    return worst;
}

} // namespace fettle::fit
