#pragma once

#include <Eigen/Core>

#include <optional>

namespace fettle {

// Eigen's decompositions take seconds to compile in each file that names one: these are compiled once.

template <int kSize>
struct SymmetricEigen {
    Eigen::Matrix<double, kSize, 1> values;      ///< ascending
    Eigen::Matrix<double, kSize, kSize> vectors; ///< of unit length, a column each
};

/// Of a symmetric matrix, of which the lower half is read. kSize: 2, 3, 6 or Eigen::Dynamic
template <int kSize>
SymmetricEigen<kSize> symmetric_eigen(const Eigen::Matrix<double, kSize, kSize>& A);

struct Orthogonal {
    Eigen::MatrixXd Q; ///< the first p columns span those of A, the others are orthogonal to them
    Eigen::MatrixXd R; ///< p × p, upper triangle: A = Q R with the first p columns of Q
};

/// Householder's decomposition of A, n × p with n ≥ p, as far as the first `columns` of Q.
Orthogonal orthogonal(const Eigen::MatrixXd& A, Eigen::Index columns);

/// W with W Wᵀ = (Aᵀ A)⁻¹, by QR with column pivoting; nothing where A has not full rank.
/// @param threshold  pivots below this share of the largest count as 0
std::optional<Eigen::MatrixXd> root_of_inverse(const Eigen::MatrixXd& A, double threshold);

struct LeastSquares {
    Eigen::VectorXd x;
    Eigen::Index rank = 0; ///< of A
};

/// min |A x - b| by QR with column pivoting; where A has not full rank, some of x are 0.
/// @param threshold  pivots below this share of the largest count as 0; nothing: those of rounding
LeastSquares least_squares_by_qr(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                 std::optional<double> threshold = std::nullopt);

/// The same by complete orthogonal decomposition; where A has not full rank, the shortest x.
LeastSquares shortest_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                    std::optional<double> threshold = std::nullopt);

} // namespace fettle
