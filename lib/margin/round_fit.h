#pragma once

#include <Eigen/Core>

namespace fettle {

/// The circle (or sphere) through points of the plane (of space), after Wang 2007, 4.5.
struct RoundFit {
    double curvature = 0; ///< equivalent curvature, 1/radius; 0 for points on a line or plane
    double variance = 0;  ///< "surface variance": farthest less nearest distance of a point from the centre
};

inline constexpr int kLeastRoundPoints = 4;

/// Algebraic fit whose bias is small even for short arcs (Pratt 1987).
/// @param points  2xN or 3xN, N >= kLeastRoundPoints
RoundFit fit_round(const Eigen::MatrixXd& points);

} // namespace fettle
