#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

namespace fettle::geometry {

// Quadratics c·quadratic_terms(u, v) over a plane by weighted least squares. The coordinates start at the point of
// interest, where the value is c[0] and the slopes are c[1] and c[2], and are scaled to about 1: normal equations then
// lose few digits.

/// 1, u, v, u², u v, v².
using QuadraticTerms = Eigen::Matrix<double, 6, 1>;

inline QuadraticTerms quadratic_terms(double u, double v) { return {1, u, v, u * u, u * v, v * v}; }

/// Quadratics of K quantities over the same points.
template <int K>
struct Quadratics {
    Eigen::Matrix<double, 6, K> coefficients; ///< one column per quantity
    QuadraticTerms pivots;                    ///< diagonal of the Cholesky factor of the normal equations
};

/// Their normal equations A c = b.
template <int K>
struct QuadraticEquations {
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, K> b = Eigen::Matrix<double, 6, K>::Zero();

    void add_point(const QuadraticTerms& terms, const Eigen::Matrix<double, K, 1>& values, double weight = 1)
    {
        const QuadraticTerms weighted = weight * terms;
        A.noalias() += weighted * terms.transpose();
        b.noalias() += weighted * values.transpose();
    }

    /// Nothing if the points do not determine a quadratic. With rounding they may seem to: compare the pivots.
    std::optional<Quadratics<K>> solve() const
    {
        const Eigen::LLT<Eigen::Matrix<double, 6, 6>> cholesky(A);
        if (cholesky.info() != Eigen::Success) return std::nullopt;
        return Quadratics<K>{cholesky.solve(b), cholesky.matrixLLT().diagonal()};
    }
};

/// Widest angle between successive directions around a point, rad: it is surrounded if that is small.
/// @param directions  their angles, rad, at least one
inline double widest_gap(std::vector<double> directions)
{
    std::sort(directions.begin(), directions.end());
    double widest = directions.front() + 2 * std::numbers::pi - directions.back();
    for (std::size_t i = 1; i < directions.size(); ++i) widest = std::max(widest, directions[i] - directions[i - 1]);
    return widest;
}

} // namespace fettle::geometry
