#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace fettle::core {

struct BoundedSolution {
    Eigen::VectorXd x;
    bool converged = false;
};

/// Minimises |A x - b| subject to lower ≤ x ≤ upper, for a large sparse A: projected gradients find the active bounds,
/// conjugate gradients the free unknowns (Moré & Toraldo 1991). Converged if the maximum norm of the projected gradient
/// is at most `tolerance` times that of the gradient at x = 0, in unknowns scaled so that A's columns have length 1.
/// Unknowns with an empty column keep their start.
/// @param start  is clamped to the bounds first
/// @throws InputError if a lower bound is above the upper
BoundedSolution bounded_least_squares(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                      const Eigen::VectorXd& start, double tolerance = 1e-8);

} // namespace fettle::core
