#pragma once

#include "fit/fit.h"

namespace fettle::fit {

/// The roles that Wang's two methods use: samples and estimated points.
inline const std::vector<int> kSampleAndEstimatedRoles = {1, 2, 3, 4, 5};

/// Derivatives ∂z_i/∂z_j of all points' heights by those of the touches: unit columns for touches, the weights of the
/// two cubics for estimated points, which have no error of their own. If input.curves is empty, estimated points count
/// as touches.
/// @param surface  begun from `input` with kSampleAndEstimatedRoles
/// @return points x points; the columns of estimated points are 0
Eigen::MatrixXd touch_jacobian(const FitInput& input, const surface::Surface& surface);

} // namespace fettle::fit
