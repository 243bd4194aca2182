#include "margin/round_fit.h"

#include "core/decompositions.h"

#include <cmath>

namespace fettle::margin {

namespace {

// Lower bound of M's eigenvalues, relative to the largest. Points exactly on a circle make the smallest one a rounding
// error.
constexpr double kMinRelativeEigenvalue = 1e-12;

/// The solution of M v = e N v with the smallest positive e, scaled to v'N v = 1. M is positive, N has one negative
/// eigenvalue.
Eigen::VectorXd smallest_positive(const Eigen::MatrixXd& M, const Eigen::MatrixXd& N, const Eigen::MatrixXd& N_inverse)
{
    // With W W = M, e is an eigenvalue of the symmetric W N⁻¹ W, too, and v = N⁻¹ W u with its vector u.
    const core::SymmetricEigen<Eigen::Dynamic> m = core::symmetric_eigen<Eigen::Dynamic>(M);
    const Eigen::VectorXd roots = m.values.cwiseMax(kMinRelativeEigenvalue * m.values.maxCoeff()).cwiseSqrt();
    const Eigen::MatrixXd W = m.vectors * roots.asDiagonal() * m.vectors.transpose();
    const Eigen::VectorXd v = N_inverse * W * core::symmetric_eigen<Eigen::Dynamic>(W * N_inverse * W).vectors.col(1);
    return v / std::sqrt(v.dot(N * v));
}

} // namespace

RoundFit fit_round(const Eigen::MatrixXd& points)
{
    // Minimise sum (A |p|² + b·p + d)² with |b|² - 4 A d = 1, the square of the gradient on the circle (Pratt 1987):
    // the smallest positive eigenvalue of M v = e N v. Centred and scaled, so that the columns of M are comparable.
    const Eigen::Index n = points.rows();
    const Eigen::VectorXd centre = points.rowwise().mean();
    const Eigen::MatrixXd offset = points.colwise() - centre;
    const double scale = std::sqrt(offset.squaredNorm() / points.cols());
    const Eigen::MatrixXd p = offset / scale;
    Eigen::MatrixXd design(points.cols(), n + 2);
    design << p.colwise().squaredNorm().transpose(), p.transpose(), Eigen::VectorXd::Ones(points.cols());
    Eigen::MatrixXd constraint = Eigen::MatrixXd::Identity(n + 2, n + 2);
    constraint(0, 0) = constraint(n + 1, n + 1) = 0;
    constraint(0, n + 1) = constraint(n + 1, 0) = -2;

    Eigen::MatrixXd inverse = constraint;
    inverse(0, n + 1) = inverse(n + 1, 0) = -0.5;
    const Eigen::VectorXd v = smallest_positive(design.transpose() * design, constraint, inverse);

    // Distance of p to the circle, centre -b / 2A: d = 2 q / (1 + sqrt(1 + 4 A q)) with q = A |p|² + b·p + d, so that
    // it holds for A = 0, a line.
    const Eigen::VectorXd q = design * v;
    const Eigen::VectorXd distance = (2 * q.array() / (1 + (1 + 4 * v[0] * q.array()).max(0).sqrt())).matrix();
    return {2 * std::abs(v[0]) / scale, (distance.maxCoeff() - distance.minCoeff()) * scale};
}

} // namespace fettle::margin
