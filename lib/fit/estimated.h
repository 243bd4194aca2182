#pragma once

#include "fit/fit.h"

namespace fettle {

/// The roles that Wang's two methods use: samples and estimated points.
inline const std::vector<int> kSampleAndEstimatedRoles = {1, 2, 3, 4, 5};

/// Number of each touch's line for the touches that the surface rests on; empty: unknown.
Eigen::VectorXi used_curves(const FitInput& input);

/// How the z of each point follows the independent touches: unit columns for touches, the weights of the two cubics
/// for estimated points, which have no error of their own. Without the lines they count as touches.
/// @return points x touches
Eigen::MatrixXd dependence(const Job& job, const Eigen::Matrix3Xd& points, const Eigen::VectorXi& roles,
                           const Eigen::VectorXi& curves);

} // namespace fettle
