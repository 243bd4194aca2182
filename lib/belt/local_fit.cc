#include "belt/local_fit.h"

#include "geometry/local_quadratic.h"

#include <cmath>

namespace fettle::belt {
namespace {

// About two rings of a lattice without the part beyond an edge; a quadratic has six coefficients.
constexpr std::size_t kMaxNeighbours = 21;
constexpr std::size_t kMinNeighbours = 7;
// Ratio of the smallest to the largest pivot of the scaled equations; for collinear neighbours it is of rounding size.
constexpr double kMinPivotRatio = 1e-6;

using Values = Eigen::Matrix<double, 7, 1>; ///< position, normal, displacement

} // namespace

std::optional<LocalFit> local_fit(const Surfels& surfels, int patch, const Eigen::Vector2d& uv,
                                  const std::vector<Eigen::Index>& candidates)
{
    std::vector<Eigen::Index> near;
    Eigen::Vector2d scale = Eigen::Vector2d::Zero();
    for (const Eigen::Index j : candidates) {
        if (surfels.patch[j] != patch || std::isnan(surfels.displacement[j])) continue;
        if (near.size() == kMaxNeighbours) break;
        near.push_back(j);
        scale = scale.cwiseMax((surfels.uv.col(j) - uv).cwiseAbs());
    }
    if (near.size() < kMinNeighbours || !(scale.minCoeff() > 0)) return std::nullopt;
    geometry::QuadraticEquations<7> equations;
    // Positions relative to one of the surfels: with large coordinates the sums would lose digits.
    const Eigen::Vector3d origin = surfels.position.col(near.front());
    for (const Eigen::Index j : near) {
        const Eigen::Vector2d d = (surfels.uv.col(j) - uv).cwiseQuotient(scale);
        Values values;
        values << surfels.position.col(j) - origin, surfels.normal.col(j), surfels.displacement[j];
        equations.add_point(geometry::quadratic_terms(d[0], d[1]), values);
    }
    const auto fit = equations.solve();
    if (!fit || fit->pivots.minCoeff() < std::sqrt(kMinPivotRatio) * fit->pivots.maxCoeff()) return std::nullopt;
    const Eigen::Matrix<double, 6, 7>& x = fit->coefficients;
    const Values value = x.row(0).transpose();
    const Values in_u = x.row(1).transpose() / scale[0], in_v = x.row(2).transpose() / scale[1];
    return LocalFit{origin + value.head<3>(), value.segment<3>(3), value[6], in_u.head<3>(), in_v.head<3>(),
                    in_u.segment<3>(3),       in_v.segment<3>(3),  in_u[6],  in_v[6]};
}

} // namespace fettle::belt
