#include "belt/edges.h"

#include "belt/sampling.h"
#include "geometry/point_index.h"
#include "mesh/mesh_index.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::belt {
namespace {

// Surfels closer than this coincide, relative to e: more than rounding.
constexpr double kCoincidenceTolerance = 1e-6;

/// Arc lengths of the surfels on a curve of a given length.
std::vector<double> surfel_distances(double length, double spacing, double e)
{
    const double steps = std::max(1.0, std::ceil(length / spacing - kCoincidenceTolerance));
    const double L = length / steps;
    const auto n = static_cast<int>(std::floor(L / e + kCoincidenceTolerance));
    std::vector<double> distances;
    for (int k = 0; k < static_cast<int>(steps); ++k) {
        distances.push_back(k * L);
        for (int i = 1; i <= n; ++i)
            if (std::abs(i * e - L) > kCoincidenceTolerance * e) distances.push_back(k * L + i * e);
    }
    return distances;
}

void append_curve(std::vector<Surfel>& surfels, const EdgeCurve& curve, double e)
{
    const Eigen::Index last = curve.points.cols() - 1;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(last + 1);
    for (Eigen::Index i = 1; i <= last; ++i)
        along[i] = along[i - 1] + (curve.points.col(i) - curve.points.col(i - 1)).norm();
    if (!(along[last] > kCoincidenceTolerance * e)) return; // a side that is collapsed to a point
    check_surfel_count(double(surfels.size()) + along[last] / curve.spacing + along[last] / e, curve.patch);
    Eigen::Index piece = 0;
    for (const double distance : surfel_distances(along[last], curve.spacing, e)) {
        while (piece + 2 <= last && along[piece + 1] <= distance) ++piece;
        const double fraction = std::min((distance - along[piece]) / (along[piece + 1] - along[piece]), 1.0);
        const auto interpolate = [&](const auto& columns) {
            return ((1 - fraction) * columns.col(piece) + fraction * columns.col(piece + 1)).eval();
        };
        const Eigen::Vector3d normal = interpolate(curve.normals);
        if (!(normal.norm() > 0)) continue; // on a facet without area
        surfels.push_back({interpolate(curve.points), normal.normalized(), interpolate(curve.uv), e, curve.patch});
    }
}

/// The segments of the curves as a mesh of degenerate triangles, for MeshIndex.
mesh::Mesh needle_mesh(const std::vector<EdgeCurve>& curves)
{
    Eigen::Index points = 0, segments = 0;
    for (const EdgeCurve& curve : curves) {
        if (curve.smooth) continue;
        points += curve.points.cols();
        segments += curve.points.cols() - 1;
    }
    mesh::Mesh mesh{Eigen::Matrix3Xd(3, points), Eigen::Matrix3Xi(3, segments)};
    Eigen::Index point = 0, segment = 0;
    for (const EdgeCurve& curve : curves) {
        if (curve.smooth) continue;
        mesh.vertices.middleCols(point, curve.points.cols()) = curve.points;
        for (Eigen::Index i = 1; i < curve.points.cols(); ++i) {
            const auto b = static_cast<int>(point + i);
            mesh.triangles.col(segment++) << b - 1, b, b;
        }
        point += curve.points.cols();
    }
    return mesh;
}

/// Adds the areas of removed surfels to the nearest ones on the curves, of the same patch if one is near.
void transfer_areas(const std::vector<Surfel>& removed, std::vector<Surfel>& surfels, std::size_t first_on_curve)
{
    if (first_on_curve == surfels.size()) return;
    Eigen::Matrix3Xd positions(3, surfels.size() - first_on_curve);
    for (Eigen::Index i = 0; i < positions.cols(); ++i) positions.col(i) = surfels[first_on_curve + i].position;
    const geometry::PointIndex<3> neighbours(positions);
    constexpr Eigen::Index kCandidates = 8; // several patches may meet
    for (const Surfel& surfel : removed) {
        const std::vector<Eigen::Index> near = neighbours.nearest(surfel.position, kCandidates);
        const auto same_patch = std::find_if(near.begin(), near.end(), [&](Eigen::Index i) {
            return surfels[first_on_curve + i].patch == surfel.patch;
        });
        surfels[first_on_curve + (same_patch != near.end() ? *same_patch : near.front())].area += surfel.area;
    }
}

} // namespace

Surfels to_surfels(const std::vector<Surfel>& list)
{
    const Eigen::Index size = std::ssize(list);
    Surfels surfels{Eigen::Matrix3Xd(3, size),   Eigen::Matrix3Xd(3, size), Eigen::VectorXd(size),
                    Eigen::VectorXd::Zero(size), Eigen::Matrix2Xd(2, size), Eigen::VectorXi(size),
                    Eigen::VectorXd(size)};
    for (Eigen::Index i = 0; i < size; ++i) {
        const Surfel& surfel = list[i];
        surfels.position.col(i) = surfel.position;
        surfels.normal.col(i) = surfel.normal;
        surfels.uv.col(i) = surfel.uv;
        surfels.radius[i] = surfel.radius;
        surfels.patch[i] = surfel.patch;
        surfels.area[i] = surfel.area;
    }
    return surfels;
}

EdgeCounts resample_boundaries(std::vector<Surfel>& surfels, const std::vector<EdgeCurve>& curves, double e)
{
    EdgeCounts counts;
    std::vector<double> distances(surfels.size(), std::numeric_limits<double>::infinity());
    const mesh::Mesh needles = needle_mesh(curves);
    if (needles.triangles.cols() > 0) {
        const mesh::MeshIndex index(needles);
        tbb::parallel_for(std::size_t{0}, surfels.size(), [&](std::size_t i) {
            const auto foot = index.closest(surfels[i].position, std::max(surfels[i].radius, e));
            if (foot) distances[i] = (foot->point - surfels[i].position).norm();
        });
    }
    std::vector<Surfel> kept, removed;
    kept.reserve(surfels.size());
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        if (distances[i] < e / 2 * (1 - kCoincidenceTolerance)) {
            removed.push_back(surfels[i]);
            continue;
        }
        kept.push_back(surfels[i]);
        if (distances[i] >= surfels[i].radius) continue;
        kept.back().radius = distances[i];
        ++counts.shrunk;
    }
    const std::size_t first_on_curve = kept.size();
    for (const EdgeCurve& curve : curves) append_curve(kept, curve, curve.smooth ? curve.spacing : e);
    counts.on_edges = kept.size() - first_on_curve;
    transfer_areas(removed, kept, first_on_curve);
    surfels = std::move(kept);
    return counts;
}

} // namespace fettle::belt
