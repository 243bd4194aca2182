#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::compare {

/// The step x within |x_k| <= reach that minimises the largest |r_i + g_iᵀ x|.
struct ChebyshevStep {
    Eigen::VectorXd x;
    double largest = 0;                 ///< |r + gᵀ x|
    std::vector<Eigen::Index> contacts; ///< active points: their multipliers are positive
    bool bounded = false;               ///< the bound on x is active as well
    bool solved = false;                ///< false: too many exchanges
};

/// Linear Chebyshev approximation by exchange of one point at a time: the simplex method on the dual programme
///   max Σ λ_j s_j r_j   with   Σ λ_j s_j g_j = 0,  Σ λ_j = 1,  λ >= 0,  s_j = ±1
/// whose basis is the set of contact points (Stiefel 1959; Barrodale & Phillips 1975).
/// @param r  n   @param G  m x n, columns g_i; both of similar size, so scale the parameters
ChebyshevStep chebyshev_step(const Eigen::VectorXd& r, const Eigen::MatrixXd& G, double reach);

} // namespace fettle::compare
