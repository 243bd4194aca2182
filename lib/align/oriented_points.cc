#include "align/oriented_points.h"

#include "cloud/neighbours.h"
#include "core/decompositions.h"

#include <Eigen/Core>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

// Enough for a plane to average noise, few enough to stay on one face.
constexpr Eigen::Index kNeighbours = 16;

Eigen::Matrix3Xd fitted_normals(const Eigen::Matrix3Xd& xyz)
{
    const Neighbours neighbours(xyz);
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, xyz.cols());
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, xyz.cols()), [&](const auto& range) {
        for (Eigen::Index i = range.begin(); i < range.end(); ++i) {
            const std::vector<Eigen::Index> near = neighbours.nearest(xyz.col(i), kNeighbours);
            if (near.size() < 3) continue;
            Eigen::Matrix3Xd local = xyz(Eigen::all, near);
            local.colwise() -= Eigen::Vector3d(local.rowwise().mean());
            const SymmetricEigen<3> spread = symmetric_eigen<3>(local * local.transpose());
            normals.col(i) = spread.vectors.col(0);
        }
    });
    return normals;
}

} // namespace

OrientedPoints oriented_points(const Cloud& cloud)
{
    std::vector<Eigen::Index> there;
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        if (cloud.xyz.col(i).allFinite()) there.push_back(i);
    OrientedPoints points;
    points.xyz = cloud.xyz(Eigen::all, there);
    if (!has_normals(cloud)) {
        points.normals = fitted_normals(points.xyz);
        return points;
    }
    points.normals = normals(cloud)(Eigen::all, there);
    for (auto normal : points.normals.colwise()) {
        const double length = normal.norm();
        if (length > 0 && std::isfinite(length))
            normal /= length;
        else
            normal.setZero();
    }
    return points;
}

OrientedPoints oriented_points(const Mesh& mesh, Eigen::Index count)
{
    const Eigen::Matrix3Xd facet_normals = triangle_normals(mesh);
    const auto corner = [&](int k, Eigen::Index t) { return Eigen::Vector3d(mesh.vertices.col(mesh.triangles(k, t))); };
    Eigen::VectorXd until(mesh.triangles.cols()); // area of the facets up to this one
    double total = 0;
    for (Eigen::Index t = 0; t < until.size(); ++t) {
        const Eigen::Vector3d a = corner(0, t);
        until[t] = total += (corner(1, t) - a).cross(corner(2, t) - a).norm() / 2;
    }
    OrientedPoints points;
    if (!(total > 0)) return points;
    points.xyz.resize(3, count);
    points.normals.resize(3, count);
    // R2 (Roberts 2018): multiples of 1/g and 1/g² with g the plastic number fill a square evenly.
    constexpr double kPlastic = 1.32471795724474602596;
    for (Eigen::Index i = 0; i < count; ++i) {
        const double area = total * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const Eigen::Index t = std::lower_bound(until.begin(), until.end() - 1, area) - until.begin();
        double u = std::fmod(static_cast<double>(i + 1) / kPlastic, 1.0);
        double v = std::fmod(static_cast<double>(i + 1) / (kPlastic * kPlastic), 1.0);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        points.xyz.col(i) = corner(0, t) + u * (corner(1, t) - corner(0, t)) + v * (corner(2, t) - corner(0, t));
        points.normals.col(i) = facet_normals.col(t);
    }
    return points;
}

std::vector<Eigen::Index> farthest_points(const Eigen::Matrix3Xd& points, Eigen::Index count)
{
    std::vector<Eigen::Index> chosen;
    if (points.cols() == 0) return chosen;
    const Eigen::Vector3d middle = points.rowwise().mean();
    Eigen::Index next = 0;
    (points.colwise() - middle).colwise().squaredNorm().maxCoeff(&next);
    Eigen::RowVectorXd squared = Eigen::RowVectorXd::Constant(points.cols(), std::numeric_limits<double>::infinity());
    while (static_cast<Eigen::Index>(chosen.size()) < std::min(count, points.cols())) {
        chosen.push_back(next);
        const Eigen::Vector3d last = points.col(next);
        squared = squared.cwiseMin((points.colwise() - last).colwise().squaredNorm());
        squared.maxCoeff(&next);
    }
    return chosen;
}

std::vector<Eigen::Index> every_nth(Eigen::Index points, Eigen::Index count)
{
    std::vector<Eigen::Index> chosen(static_cast<std::size_t>(std::min(points, count)));
    const auto n = static_cast<Eigen::Index>(chosen.size());
    for (Eigen::Index i = 0; i < n; ++i) chosen[static_cast<std::size_t>(i)] = i * points / n;
    return chosen;
}

} // namespace fettle
