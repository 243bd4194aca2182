#include "belt/local_fit.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace fettle {
namespace {

// Two rings of a lattice less what an edge cuts off: a quadratic has six coefficients.
constexpr std::size_t kMostNeighbours = 21;
constexpr std::size_t kLeastNeighbours = 7;
// Of the pivots of the scaled equations to the largest: neighbours on a line leave zero but for rounding.
constexpr double kSingular = 1e-6;

using Terms = Eigen::Matrix<double, 6, 1>;  ///< 1, du, dv, du², du dv, dv²
using Values = Eigen::Matrix<double, 7, 1>; ///< position, normal, displacement

} // namespace

std::optional<LocalFit> local_fit(const Surfels& surfels, int patch, const Eigen::Vector2d& uv,
                                  const std::vector<Eigen::Index>& candidates)
{
    std::vector<Eigen::Index> near;
    Eigen::Vector2d scale = Eigen::Vector2d::Zero();
    for (const Eigen::Index j : candidates) {
        if (surfels.patch[j] != patch || std::isnan(surfels.displacement[j])) continue;
        if (near.size() == kMostNeighbours) break;
        near.push_back(j);
        scale = scale.cwiseMax((surfels.uv.col(j) - uv).cwiseAbs());
    }
    if (near.size() < kLeastNeighbours || !(scale.minCoeff() > 0)) return std::nullopt;
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 7> b = Eigen::Matrix<double, 6, 7>::Zero();
    // Places are taken from one of the surfels: their squares would swallow what is left of them.
    const Eigen::Vector3d origin = surfels.position.col(near.front());
    for (const Eigen::Index j : near) {
        const Eigen::Vector2d d = (surfels.uv.col(j) - uv).cwiseQuotient(scale);
        const Terms terms(1, d[0], d[1], d[0] * d[0], d[0] * d[1], d[1] * d[1]);
        Values values;
        values << surfels.position.col(j) - origin, surfels.normal.col(j), surfels.displacement[j];
        A += terms * terms.transpose();
        b += terms * values.transpose();
    }
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(A);
    const Terms pivots = factor.matrixLLT().diagonal();
    if (factor.info() != Eigen::Success || pivots.minCoeff() < std::sqrt(kSingular) * pivots.maxCoeff())
        return std::nullopt;
    const Eigen::Matrix<double, 6, 7> x = factor.solve(b);
    const Values here = x.row(0).transpose();
    const Values in_u = x.row(1).transpose() / scale[0], in_v = x.row(2).transpose() / scale[1];
    return LocalFit{origin + here.head<3>(), here.segment<3>(3), here[6], in_u.head<3>(), in_v.head<3>(),
                    in_u.segment<3>(3),      in_v.segment<3>(3), in_u[6], in_v[6]};
}

} // namespace fettle
