#include "align/oriented_points.h"

#include "cloud/viewpoint.h"
#include "geometry/orientation.h"
#include "geometry/plane_normals.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace fettle::align {

namespace {

/// Normals of planes fitted to the nearest points: to the side of the viewpoint, else all to one side of the surface.
Eigen::Matrix3Xd estimate_normals(const Eigen::Matrix3Xd& xyz, const cloud::Cloud& cloud)
{
    geometry::PlaneNormals planes = geometry::plane_normals(xyz);
    if (cloud::has_viewpoint(cloud)) {
        const Eigen::Matrix3Xd towards = (-xyz).colwise() + cloud.view_origin;
        for (Eigen::Index i = 0; i < xyz.cols(); ++i)
            if (planes.normals.col(i).dot(towards.col(i)) < 0) planes.normals.col(i) *= -1;
    } else {
        geometry::orient_consistently(planes.normals, xyz, planes.links, Eigen::Matrix3Xd::Zero(3, xyz.cols()));
    }
    return std::move(planes.normals);
}

/// Points near each other, and the one of them that is farthest from all samples.
struct Bucket {
    std::span<const Eigen::Index> points; ///< ascending
    Eigen::AlignedBox3d box;
    double max_squared = std::numeric_limits<double>::infinity();
    Eigen::Index farthest = 0;
};

/// Halves the points across the longest side of their box until the halves are small.
/// @param order  their columns, which are reordered; the buckets refer to it
void split_into_buckets(const Eigen::Matrix3Xd& points, std::span<Eigen::Index> order, std::vector<Bucket>& buckets)
{
    constexpr std::size_t kMaxBucket = 64; // about as much work to go through as the boxes of all buckets
    Eigen::AlignedBox3d box;
    for (const Eigen::Index i : order) box.extend(points.col(i));
    if (order.size() <= kMaxBucket) {
        std::ranges::sort(order);
        buckets.push_back({order, box});
        return;
    }
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t half = order.size() / 2;
    std::ranges::nth_element(order, order.begin() + half, {}, [&](Eigen::Index i) { return points(axis, i); });
    split_into_buckets(points, order.first(half), buckets);
    split_into_buckets(points, order.subspan(half), buckets);
}

} // namespace

OrientedPoints oriented_points(const cloud::Cloud& cloud)
{
    std::vector<Eigen::Index> finite;
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        if (cloud.xyz.col(i).allFinite()) finite.push_back(i);
    OrientedPoints points;
    points.xyz = cloud.xyz(Eigen::all, finite);
    if (!cloud::has_normals(cloud)) {
        points.normals = estimate_normals(points.xyz, cloud);
        return points;
    }
    points.outward = true;
    points.normals = cloud::normals(cloud)(Eigen::all, finite);
    for (auto normal : points.normals.colwise()) {
        const double length = normal.norm();
        if (length > 0 && std::isfinite(length))
            normal /= length;
        else
            normal.setZero();
    }
    return points;
}

OrientedPoints oriented_points(const mesh::Mesh& mesh, Eigen::Index count)
{
    const Eigen::Matrix3Xd facet_normals = mesh::triangle_normals(mesh);
    const auto corner = [&](int k, Eigen::Index t) { return Eigen::Vector3d(mesh.vertices.col(mesh.triangles(k, t))); };
    Eigen::VectorXd cumulative_area(mesh.triangles.cols());
    double total = 0;
    for (Eigen::Index t = 0; t < cumulative_area.size(); ++t) {
        const Eigen::Vector3d a = corner(0, t);
        cumulative_area[t] = total += (corner(1, t) - a).cross(corner(2, t) - a).norm() / 2;
    }
    OrientedPoints points;
    points.outward = true;
    if (!(total > 0)) return points;
    points.xyz.resize(3, count);
    points.normals.resize(3, count);
    // R2 sequence (Roberts 2018): multiples of 1/g and 1/g² modulo 1, g the plastic number, fill the unit square
    // evenly.
    constexpr double kPlastic = 1.32471795724474602596;
    for (Eigen::Index i = 0; i < count; ++i) {
        const double area = total * (i + 0.5) / count;
        const Eigen::Index t =
            std::lower_bound(cumulative_area.begin(), cumulative_area.end() - 1, area) - cumulative_area.begin();
        double u = std::fmod((i + 1) / kPlastic, 1.0);
        double v = std::fmod((i + 1) / (kPlastic * kPlastic), 1.0);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        points.xyz.col(i) = corner(0, t) + u * (corner(1, t) - corner(0, t)) + v * (corner(2, t) - corner(0, t));
        points.normals.col(i) = facet_normals.col(t);
    }
    return points;
}

std::vector<Eigen::Index> farthest_point_sample(const Eigen::Matrix3Xd& points, Eigen::Index count)
{
    std::vector<Eigen::Index> chosen;
    if (points.cols() == 0) return chosen;
    const Eigen::Vector3d centroid = points.rowwise().mean();
    Eigen::Index next = 0;
    (points.colwise() - centroid).colwise().squaredNorm().maxCoeff(&next);
    std::vector<Eigen::Index> order(points.cols());
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::vector<Bucket> buckets;
    split_into_buckets(points, order, buckets);
    Eigen::RowVectorXd squared = Eigen::RowVectorXd::Constant(points.cols(), std::numeric_limits<double>::infinity());
    for (Eigen::Index k = 0; k < std::min(count, points.cols()); ++k) {
        chosen.push_back(next);
        const Eigen::Vector3d last = points.col(next);
        const Bucket* best = nullptr;
        for (Bucket& bucket : buckets) {
            // A sample changes nothing where it is farther off than the samples before it.
            if (bucket.box.squaredExteriorDistance(last) < bucket.max_squared) {
                bucket.max_squared = -1;
                for (const Eigen::Index i : bucket.points) {
                    squared[i] = std::min(squared[i], (points.col(i) - last).squaredNorm());
                    if (squared[i] <= bucket.max_squared) continue;
                    bucket.max_squared = squared[i];
                    bucket.farthest = i;
                }
            }
            if (!best || bucket.max_squared > best->max_squared ||
                (bucket.max_squared == best->max_squared && bucket.farthest < best->farthest))
                best = &bucket;
        }
        next = best->farthest;
    }
    return chosen;
}

std::vector<Eigen::Index> scattered_indices(Eigen::Index size, Eigen::Index count)
{
    const Eigen::Index n = std::min(size, count);
    std::vector<Eigen::Index> indices(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index begin = i * size / n, end = (i + 1) * size / n;
        const double share = std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
        indices[i] = begin + static_cast<Eigen::Index>(share * static_cast<double>(end - begin));
    }
    return indices;
}

} // namespace fettle::align
