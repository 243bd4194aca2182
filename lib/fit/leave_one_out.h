#pragma once

#include <Eigen/Core>

namespace fettle::fit {

/// What a mixture of models predicts of each touch from the other touches: in each model a normal distribution (Wahba
/// 1990, 4.2). All matrices are touches x models.
struct LeaveOneOut {
    Eigen::MatrixXd deviation;  ///< touch minus prediction
    Eigen::MatrixXd variance;   ///< of that deviation, the touch's own noise included
    Eigen::MatrixXd log_weight; ///< ln probability of the model given the other touches, up to a constant for each row
};

/// The most probable outlier: a touch that lies farther than kMinOutlierDeviations standard deviations from what the
/// others predict, and whose density there is below that of an outlier. The first condition protects true touches: the
/// models are stationary, a part is not. The one touch on a peak lies a few standard deviations from what the flatter
/// rest predicts, and nothing else shows the peak.
/// @param log_outlier  ln of an outlier's density times its prior odds, in the unit of `deviation`
/// @return  -1 if there is none
Eigen::Index most_probable_outlier(const LeaveOneOut& predictions, double log_outlier);

/// In 36 draws on Franke's surfaces (1979), whose peaks are as narrow as the spacing of the touches, no true touch is
/// more than 6 standard deviations off. Outliers of 5 mm on smooth castings are 13 and more off.
inline constexpr double kMinOutlierDeviations = 8;

} // namespace fettle::fit
