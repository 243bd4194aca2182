#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <cstdint>

namespace fettle {

/// Errors that a fit leaves possible: height fields drawn from its covariance and its alternatives by their weight,
/// less their mean. Each is drawn with both signs, one after the other.
/// @param xy  2xN, M   @param draws  even
/// @return  N x draws, mm; a member that is not defined all over xy takes no part
Eigen::MatrixXd draw_fields(const Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed);

} // namespace fettle
