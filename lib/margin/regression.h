#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::margin {

/// Wang's regressions for error band and shift distance (2007, 4.5), one pair for each kind of surface.
enum class RegressionKind { swept, concave, convex, saddle };

/// The names of the terms: "curvature", "area", "farthest", "variance", "constant"; for saddles "curvature x",
/// "curvature y", "root area", "farthest", "variance x", "variance y", "constant".
const std::vector<std::string>& regression_terms(RegressionKind kind);

/// Values of the terms, in inches: curvature and "surface variance" of the circle (swept), the sphere, or the cylinders
/// along Y_w and X_w (saddle: x, y) through the touches; area of B; distance of the farthest touch from B; 1.
/// @param touches  3xN, N >= kMinRoundPoints, M, mm, without estimated points
Eigen::VectorXd regression_values(RegressionKind kind, const Eigen::Matrix3Xd& touches, const job::Job& job);

/// The published coefficients, for lengths in inches.
struct Regression {
    Eigen::VectorXd band, shift;
};
const Regression& published_regression(RegressionKind kind);

} // namespace fettle::margin
