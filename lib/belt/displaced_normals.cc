#include "belt/displaced_normals.h"

#include "belt/local_fit.h"
#include "geometry/point_index.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle::belt {
namespace {

/// Larger absolute principal curvature, from the first and second fundamental forms, 1/mm.
double max_curvature(const LocalFit& d)
{
    Eigen::Matrix2d first, second;
    first << d.P_u.dot(d.P_u), d.P_u.dot(d.P_v), d.P_u.dot(d.P_v), d.P_v.dot(d.P_v);
    const double mixed = (d.n_u.dot(d.P_v) + d.n_v.dot(d.P_u)) / 2;
    second << d.n_u.dot(d.P_u), mixed, mixed, d.n_v.dot(d.P_v);
    const double det = first.determinant(); // EG - F²
    if (!(det > 0)) return 0;
    const double mean =
        (first(0, 0) * second(1, 1) - 2 * first(0, 1) * second(0, 1) + first(1, 1) * second(0, 0)) / (2 * det);
    const double gauss = second.determinant() / det;
    return std::abs(mean) + std::sqrt(std::max(mean * mean - gauss, 0.0));
}

} // namespace

DisplacedNormals displaced_normals(const Surfels& s)
{
    const geometry::PointIndex<3> neighbours(s.position);
    DisplacedNormals result;
    result.normal = s.normal;
    Eigen::VectorXd bends = Eigen::VectorXd::Constant(s.size(), -1); // |D| κ; -1: undetermined
    tbb::parallel_for(Eigen::Index{0}, s.size(), [&](Eigen::Index i) {
        if (std::isnan(s.displacement[i])) return;
        const auto fit = local_fit(s, s.patch[i], s.uv.col(i), neighbours.nearest(s.position.col(i), kFitCandidates));
        if (!fit) return;
        const Eigen::Vector3d &P_u = fit->P_u, &P_v = fit->P_v;
        const Eigen::Vector3d n = s.normal.col(i);
        // If (u, v, n) is left-handed, all three cross products point inwards.
        const double sign = P_u.cross(P_v).dot(n) < 0 ? -1 : 1;
        result.normal.col(i) =
            (sign * (P_u.cross(P_v) + fit->D_u * n.cross(P_v) + fit->D_v * P_u.cross(n))).normalized();
        bends[i] = std::abs(s.displacement[i]) * max_curvature(*fit);
    });
    result.undetermined = (bends.array() < 0).count();
    result.above_limit = (bends.array() > kMaxDisplacementCurvature).count();
    result.max_displacement_curvature = s.size() > 0 ? std::max(bends.maxCoeff(), 0.0) : 0;
    return result;
}

} // namespace fettle::belt
