#pragma once

#include "fit/robust_spline.h"

#include <Eigen/Core>

namespace fettle::fit {

/// Heights that stand for the points of a scan.
struct Representatives {
    Eigen::Matrix3Xd xyz;    ///< M, mm
    double sigma = 0;        ///< standard deviation of each, mm
    std::size_t dropped = 0; ///< groups that were left out, far off all around them
};

/// More of them resolve no longer waves than an anomaly needs, and a Gaussian process takes their number's cube.
inline constexpr std::size_t kMaxRepresentatives = 200;

/// Thins a scan by its information: its cells are halved again and again, so that each of the groups holds the same
/// share of the points' weight; a group's height is that of the plane through it, outliers left out.
///
/// Noise that is independent from point to point averages out in a group, a scanner's waves do not. So the standard
/// deviation comes from how the quarters of a group differ from its plane, and is at least that of independent points.
Representatives condense(const DensePoints& points, const RobustSpline& spline);

} // namespace fettle::fit
