#pragma once

#include <Eigen/Core>

namespace fettle::margin {

/// The circle (or sphere) through points of the plane (of space), after Wang 2007, 4.5.
struct RoundFit {
    double curvature = 0; ///< equivalent curvature, 1/radius; 0 for points on a line or plane
    double variance = 0;  ///< Wang's "surface variance": range of the points' distances from the centre
};

inline constexpr int kMinRoundPoints = 4;

/// Pratt's algebraic fit (1987), whose bias is small even for short arcs.
/// @param points  2xN or 3xN, N >= kMinRoundPoints
RoundFit fit_round(const Eigen::MatrixXd& points);

} // namespace fettle::margin
