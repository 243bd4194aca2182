#include "margin/round_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace fettle {

RoundFit fit_round(const Eigen::MatrixXd& points)
{
    // Minimise sum (A |p|² + b·p + d)² with |b|² - 4 A d = 1, the square of the gradient on the circle (Pratt 1987):
    // the least positive eigenvalue of M v = e N v. Centred and scaled, so that the columns of M are comparable.
    const Eigen::Index n = points.rows();
    const Eigen::VectorXd centre = points.rowwise().mean();
    const Eigen::MatrixXd offset = points.colwise() - centre;
    const double scale = std::sqrt(offset.squaredNorm() / static_cast<double>(points.cols()));
    const Eigen::MatrixXd p = offset / scale;
    Eigen::MatrixXd design(points.cols(), n + 2);
    design << p.colwise().squaredNorm().transpose(), p.transpose(), Eigen::VectorXd::Ones(points.cols());
    Eigen::MatrixXd constraint = Eigen::MatrixXd::Identity(n + 2, n + 2);
    constraint(0, 0) = constraint(n + 1, n + 1) = 0;
    constraint(0, n + 1) = constraint(n + 1, 0) = -2;

    const Eigen::EigenSolver<Eigen::MatrixXd> solver(constraint.inverse() * design.transpose() * design);
    Eigen::Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < n + 2; ++i) {
        const Eigen::VectorXd v = solver.eigenvectors().col(i).real();
        const double value = solver.eigenvalues()[i].real();
        if (v.dot(constraint * v) > 0 && value < least) {
            least = value;
            best = i;
        }
    }
    Eigen::VectorXd v = solver.eigenvectors().col(best).real();
    v /= std::sqrt(v.dot(constraint * v));

    // Distance of p to the circle, centre -b / 2A: d = 2 q / (1 + sqrt(1 + 4 A q)) with q = A |p|² + b·p + d, so that
    // it holds for A = 0, a line.
    const Eigen::VectorXd q = design * v;
    const Eigen::VectorXd distance = (2 * q.array() / (1 + (1 + 4 * v[0] * q.array()).max(0).sqrt())).matrix();
    return {2 * std::abs(v[0]) / scale, (distance.maxCoeff() - distance.minCoeff()) * scale};
}

} // namespace fettle
