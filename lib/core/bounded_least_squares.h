#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace fettle {

struct BoundedSolution {
    Eigen::VectorXd x;
    bool converged = false;
    int products = 0; ///< of A or its transpose with a vector
};

/// min |A x - b| over lower ≤ x ≤ upper, A large and sparse: projected gradients find which bounds hold, conjugate
/// gradients the rest (Moré & Toraldo 1991). Converged: no step that the bounds allow is steeper than `tolerance` of
/// that at x = 0, in unknowns scaled so that A's columns have length 1. Unknowns with an empty column stay where they
/// start.
/// @param start  is moved between the bounds first
/// @throws InputError if a lower bound is above the upper
BoundedSolution bounded_least_squares(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                      const Eigen::VectorXd& start, double tolerance = 1e-8);

} // namespace fettle
