#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <cstdint>

namespace fettle::margin {

/// Draws height errors from the posterior of a fit: from its covariance and its alternatives by their weight, relative
/// to their common mean. Antithetic draws, of opposite sign about a member's mean, follow each other.
/// @param xy  2xN, M, mm   @param draws  even
/// @return  N x draws, mm; members that are not defined at all of xy are left out
/// @throws core::InputError if no member has a finite covariance
Eigen::MatrixXd draw_fields(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed);

} // namespace fettle::margin
