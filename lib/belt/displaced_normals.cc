#include "belt/displaced_normals.h"

#include "cloud/neighbours.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace fettle {
namespace {

// Nearest points among which neighbours on the patch are looked for: on an edge half of them are another patch's, and
// many lie along it.
constexpr Eigen::Index kCandidates = 32;
// Two rings of a lattice less what an edge cuts off: the quadratic has five coefficients.
constexpr std::size_t kMostNeighbours = 20;
constexpr std::size_t kLeastNeighbours = 6;
// Of the pivots of the scaled equations to the largest: neighbours on a line leave zero but for rounding.
constexpr double kSingular = 1e-6;

using Terms = Eigen::Matrix<double, 5, 1>;  ///< du, dv, du², du dv, dv²
using Values = Eigen::Matrix<double, 7, 1>; ///< position, normal, displacement: less those of the surfel

/// First derivatives at a surfel.
struct Derivatives {
    Eigen::Vector3d P_u, P_v, n_u, n_v;
    double D_u, D_v;
};

std::optional<Derivatives> derivatives(const Surfels& s, Eigen::Index i, const std::vector<Eigen::Index>& candidates)
{
    std::vector<Eigen::Index> near;
    Eigen::Vector2d scale = Eigen::Vector2d::Zero();
    for (const Eigen::Index j : candidates) {
        if (j == i || s.patch[j] != s.patch[i] || std::isnan(s.displacement[j])) continue;
        if (near.size() == kMostNeighbours) break;
        near.push_back(j);
        scale = scale.cwiseMax((s.uv.col(j) - s.uv.col(i)).cwiseAbs());
    }
    if (near.size() < kLeastNeighbours || !(scale.minCoeff() > 0)) return std::nullopt;
    Eigen::Matrix<double, 5, 5> A = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 7> b = Eigen::Matrix<double, 5, 7>::Zero();
    for (const Eigen::Index j : near) {
        const Eigen::Vector2d d = (s.uv.col(j) - s.uv.col(i)).cwiseQuotient(scale);
        const Terms terms(d[0], d[1], d[0] * d[0], d[0] * d[1], d[1] * d[1]);
        Values values;
        values << s.position.col(j) - s.position.col(i), s.normal.col(j) - s.normal.col(i),
            s.displacement[j] - s.displacement[i];
        A += terms * terms.transpose();
        b += terms * values.transpose();
    }
    const Eigen::LLT<Eigen::Matrix<double, 5, 5>> factor(A);
    const Terms pivots = factor.matrixLLT().diagonal();
    if (factor.info() != Eigen::Success || pivots.minCoeff() < std::sqrt(kSingular) * pivots.maxCoeff())
        return std::nullopt;
    const Eigen::Matrix<double, 5, 7> x = factor.solve(b);
    const Values in_u = x.row(0).transpose() / scale[0], in_v = x.row(1).transpose() / scale[1];
    return Derivatives{in_u.head<3>(), in_v.head<3>(), in_u.segment<3>(3), in_v.segment<3>(3), in_u[6], in_v[6]};
}

/// The larger principal curvature, from the first and second fundamental forms, 1/mm.
double curvature(const Derivatives& d)
{
    Eigen::Matrix2d first, second;
    first << d.P_u.dot(d.P_u), d.P_u.dot(d.P_v), d.P_u.dot(d.P_v), d.P_v.dot(d.P_v);
    const double mixed = (d.n_u.dot(d.P_v) + d.n_v.dot(d.P_u)) / 2;
    second << d.n_u.dot(d.P_u), mixed, mixed, d.n_v.dot(d.P_v);
    const double area = first.determinant();
    if (!(area > 0)) return 0;
    const double mean =
        (first(0, 0) * second(1, 1) - 2 * first(0, 1) * second(0, 1) + first(1, 1) * second(0, 0)) / (2 * area);
    const double gauss = second.determinant() / area;
    return std::abs(mean) + std::sqrt(std::max(mean * mean - gauss, 0.0));
}

} // namespace

DisplacedNormals displaced_normals(const Surfels& s)
{
    const Neighbours neighbours(s.position);
    DisplacedNormals result;
    result.normal = s.normal;
    Eigen::VectorXd bends = Eigen::VectorXd::Constant(s.size(), -1); // |D| times curvature; -1: undetermined
    tbb::parallel_for(Eigen::Index{0}, s.size(), [&](Eigen::Index i) {
        if (std::isnan(s.displacement[i])) return;
        const auto found = derivatives(s, i, neighbours.nearest(s.position.col(i), kCandidates));
        if (!found) return;
        const auto& [P_u, P_v, n_u, n_v, D_u, D_v] = *found;
        const Eigen::Vector3d n = s.normal.col(i);
        // Where u and v run the other way round than the normal says, the cross products of all three terms do.
        const double way = P_u.cross(P_v).dot(n) < 0 ? -1 : 1;
        result.normal.col(i) = (way * (P_u.cross(P_v) + D_u * n.cross(P_v) + D_v * P_u.cross(n))).normalized();
        bends[i] = std::abs(s.displacement[i]) * curvature(*found);
    });
    result.undetermined = (bends.array() < 0).count();
    result.beyond = (bends.array() > kLargestBend).count();
    result.largest_bend = s.size() > 0 ? std::max(bends.maxCoeff(), 0.0) : 0;
    return result;
}

} // namespace fettle
