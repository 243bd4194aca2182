#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>

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

/// Takes a draw: height errors at the places asked for, mm.
using FieldVisitor = std::function<void(const Eigen::VectorXd& field)>;

/// Draws height errors from the posterior of a fit: from its covariance and its alternatives by their weight, relative
/// to their common mean. Draws are in antithetic pairs, of opposite sign about a member's mean. Each draw is visited
/// and forgotten: thousands of them need no more memory than one.
/// @param xy  2xN, M, mm; members that are not defined at all of them are left out   @param draws  even
/// @param scan  of the metal around the anomaly, which says how large the waves are: 3xN, M, mm; none: the touches
/// alone
/// @throws core::InputError if no member has a finite covariance
void visit_fields(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed,
                  Tails tails, UnseenWaves waves, const Eigen::Matrix3Xd& scan, const FieldVisitor& visit);

/// Draws with normal tails and without waves, as visit_fields(). @return  N x draws, mm
Eigen::MatrixXd draw_fields(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed);

} // namespace fettle::margin
