#pragma once

#include <Eigen/Core>

namespace fettle::margin {

/// Width of the band in which an approximated surface differs from the true one (Wang 2007, eq. 4-1): max - min where
/// they differ in sign, else the largest |error|; both cases are max(0, max) - min(0, min).
/// @param errors  approximated - true height at the same (x, y)
double error_band(const Eigen::VectorXd& errors);

/// The distance to raise the approximated surface by so that it touches the true one and is nowhere below it (Wang
/// 2007, eq. 4-6); negative if it can be lowered.
double shift_distance(const Eigen::VectorXd& errors);

} // namespace fettle::margin
