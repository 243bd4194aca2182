#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <cstdint>

namespace fettle::margin {

/// Tails of the draws of a process (fit/process.h), whose amplitude is estimated from the touches.
enum class Tails {
    normal, ///< as if the amplitude were known
    /// Student's t with that covariance, and the degrees of freedom of the touches less the parameters of the process's
    /// trend (Kitanidis 1986; Handcock and Stein 1993)
    student
};

/// Waves about the families of a fit, too low for the touches to show, and with a scan those of its process
/// (margin/waves.h).
enum class UnseenWaves { none, possible };

/// Draws height errors from the posterior of a fit: from its covariance and its alternatives by their weight, relative
/// to their common mean. Draws are in antithetic pairs, of opposite sign about a member's mean.
/// @param xy  2xN, M, mm   @param draws  even
/// @param scan  of the metal around the anomaly, which says how large the waves are: 3xN, M, mm; none: the touches
/// alone
/// @return  N x draws, mm; members that are not defined at all of xy are left out
/// @throws core::InputError if no member has a finite covariance
Eigen::MatrixXd draw_fields(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed,
                            Tails tails = Tails::normal, UnseenWaves waves = UnseenWaves::none,
                            const Eigen::Matrix3Xd& scan = {});

} // namespace fettle::margin
