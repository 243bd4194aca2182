#include "belt/displaced_normals.h"

#include "belt/local_fit.h"
#include "cloud/neighbours.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

/// The larger principal curvature, from the first and second fundamental forms, 1/mm.
double curvature(const LocalFit& d)
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
        const auto found = local_fit(s, s.patch[i], s.uv.col(i), neighbours.nearest(s.position.col(i), kFitCandidates));
        if (!found) return;
        const Eigen::Vector3d &P_u = found->P_u, &P_v = found->P_v;
        const Eigen::Vector3d n = s.normal.col(i);
        // Where u and v run the other way round than the normal says, the cross products of all three terms do.
        const double way = P_u.cross(P_v).dot(n) < 0 ? -1 : 1;
        result.normal.col(i) =
            (way * (P_u.cross(P_v) + found->D_u * n.cross(P_v) + found->D_v * P_u.cross(n))).normalized();
        bends[i] = std::abs(s.displacement[i]) * curvature(*found);
    });
    result.undetermined = (bends.array() < 0).count();
    result.beyond = (bends.array() > kLargestBend).count();
    result.largest_bend = s.size() > 0 ? std::max(bends.maxCoeff(), 0.0) : 0;
    return result;
}

} // namespace fettle
