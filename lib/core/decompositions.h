#pragma once

#include <Eigen/Core>

#include <optional>

namespace fettle::core {

// Eigen's decompositions take seconds to compile in each file that names one; these wrappers are compiled once.

template <int kSize>
struct SymmetricEigen {
    Eigen::Matrix<double, kSize, 1> values;      ///< ascending
    Eigen::Matrix<double, kSize, kSize> vectors; ///< unit eigenvectors, one per column
};

/// Eigenvalues and eigenvectors of a symmetric matrix; only its lower half is read. kSize: 2, 3, 6 or Eigen::Dynamic
template <int kSize>
SymmetricEigen<kSize> symmetric_eigen(const Eigen::Matrix<double, kSize, kSize>& A);

struct QrFactors {
    Eigen::MatrixXd Q; ///< orthonormal columns: the first p span the columns of A, the others their complement
    Eigen::MatrixXd R; ///< p × p, upper triangular: A = Q R with the first p columns of Q
};

/// Householder QR decomposition of A, n × p with n ≥ p. @param columns  number of columns of Q to compute
QrFactors householder_qr(const Eigen::MatrixXd& A, Eigen::Index columns);

/// W with W Wᵀ = (Aᵀ A)⁻¹, by QR with column pivoting; nothing if A is rank deficient.
/// @param threshold  pivots below this fraction of the largest count as 0
std::optional<Eigen::MatrixXd> inverse_gram_factor(const Eigen::MatrixXd& A, double threshold);

struct LeastSquaresSolution {
    Eigen::VectorXd x;
    Eigen::Index rank = 0; ///< rank of A
};

/// Minimises |A x - b| by QR with column pivoting; if A is rank deficient, some elements of x are 0.
/// @param threshold  pivots below this fraction of the largest count as 0; without it, Eigen's default for rounding
LeastSquaresSolution least_squares_by_qr(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                         std::optional<double> threshold = std::nullopt);

/// Minimises |A x - b| by complete orthogonal decomposition; if A is rank deficient, x is the solution of minimum norm.
LeastSquaresSolution min_norm_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                            std::optional<double> threshold = std::nullopt);

} // namespace fettle::core
