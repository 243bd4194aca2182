#include "belt/edges.h"

#include "cloud/neighbours.h"
#include "mesh/mesh_index.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {
namespace {

// A surfel that lands on its neighbour does so to rounding, relative to e.
constexpr double kLanding = 1e-6;

/// Distances from the beginning of a curve of a length at which there are surfels.
std::vector<double> places_along(double length, double spacing, double e)
{
    const double steps = std::max(1.0, std::ceil(length / spacing - kLanding));
    const double L = length / steps;
    const auto n = static_cast<int>(std::floor(L / e + kLanding));
    std::vector<double> places;
    for (int k = 0; k < static_cast<int>(steps); ++k) {
        places.push_back(k * L);
        for (int i = 1; i <= n; ++i)
            if (std::abs(i * e - L) > kLanding * e) places.push_back(k * L + i * e);
    }
    return places;
}

void append_curve(std::vector<Surfel>& surfels, const EdgeCurve& curve, double e)
{
    const Eigen::Index last = curve.points.cols() - 1;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(last + 1);
    for (Eigen::Index i = 1; i <= last; ++i)
        along[i] = along[i - 1] + (curve.points.col(i) - curve.points.col(i - 1)).norm();
    if (!(along[last] > kLanding * e)) return; // a side drawn together to a point
    Eigen::Index piece = 0;
    for (const double place : places_along(along[last], curve.spacing, e)) {
        while (piece + 2 <= last && along[piece + 1] <= place) ++piece;
        const double share = std::min((place - along[piece]) / (along[piece + 1] - along[piece]), 1.0);
        const auto between = [&](const auto& columns) {
            return ((1 - share) * columns.col(piece) + share * columns.col(piece + 1)).eval();
        };
        const Eigen::Vector3d normal = between(curve.normals);
        if (!(normal.norm() > 0)) continue; // on a facet without area
        surfels.push_back({between(curve.points), normal.normalized(), between(curve.uv), e, curve.patch});
    }
}

/// The curves as a mesh of needles.
Mesh needles_of(const std::vector<EdgeCurve>& curves)
{
    Eigen::Index points = 0, pieces = 0;
    for (const EdgeCurve& curve : curves) {
        if (curve.smooth) continue;
        points += curve.points.cols();
        pieces += curve.points.cols() - 1;
    }
    Mesh mesh{Eigen::Matrix3Xd(3, points), Eigen::Matrix3Xi(3, pieces)};
    Eigen::Index point = 0, piece = 0;
    for (const EdgeCurve& curve : curves) {
        if (curve.smooth) continue;
        mesh.vertices.middleCols(point, curve.points.cols()) = curve.points;
        for (Eigen::Index i = 1; i < curve.points.cols(); ++i) {
            const auto b = static_cast<int>(point + i);
            mesh.triangles.col(piece++) << b - 1, b, b;
        }
        point += curve.points.cols();
    }
    return mesh;
}

/// Gives the areas of surfels that go to the nearest ones on the curves, of their patches if these are near.
void hand_on_areas(const std::vector<Surfel>& gone, std::vector<Surfel>& surfels, std::size_t first_on_curve)
{
    if (first_on_curve == surfels.size()) return;
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(surfels.size() - first_on_curve));
    for (Eigen::Index i = 0; i < places.cols(); ++i)
        places.col(i) = surfels[first_on_curve + static_cast<std::size_t>(i)].position;
    const Neighbours neighbours(places);
    constexpr Eigen::Index kLookedAt = 8; // where some patches meet
    for (const Surfel& surfel : gone) {
        const std::vector<Eigen::Index> near = neighbours.nearest(surfel.position, kLookedAt);
        const auto on_curve = [&](Eigen::Index i) -> Surfel& {
            return surfels[first_on_curve + static_cast<std::size_t>(i)];
        };
        const auto same =
            std::find_if(near.begin(), near.end(), [&](Eigen::Index i) { return on_curve(i).patch == surfel.patch; });
        on_curve(same != near.end() ? *same : near.front()).area += surfel.area;
    }
}

} // namespace

Surfels to_surfels(const std::vector<Surfel>& list)
{
    const auto size = static_cast<Eigen::Index>(list.size());
    Surfels surfels{Eigen::Matrix3Xd(3, size),   Eigen::Matrix3Xd(3, size), Eigen::VectorXd(size),
                    Eigen::VectorXd::Zero(size), Eigen::Matrix2Xd(2, size), Eigen::VectorXi(size),
                    Eigen::VectorXd(size)};
    for (Eigen::Index i = 0; i < size; ++i) {
        const Surfel& surfel = list[static_cast<std::size_t>(i)];
        surfels.position.col(i) = surfel.position;
        surfels.normal.col(i) = surfel.normal;
        surfels.uv.col(i) = surfel.uv;
        surfels.radius[i] = surfel.radius;
        surfels.patch[i] = surfel.patch;
        surfels.area[i] = surfel.area;
    }
    return surfels;
}

EdgeCounts resample_boundaries(std::vector<Surfel>& inside, const std::vector<EdgeCurve>& curves, double e)
{
    EdgeCounts counts;
    std::vector<double> distances(inside.size(), std::numeric_limits<double>::infinity());
    const Mesh needles = needles_of(curves);
    if (needles.triangles.cols() > 0) {
        const MeshIndex index(needles);
        tbb::parallel_for(std::size_t{0}, inside.size(), [&](std::size_t i) {
            const auto foot = index.closest(inside[i].position, std::max(inside[i].radius, e));
            if (foot) distances[i] = (foot->point - inside[i].position).norm();
        });
    }
    std::vector<Surfel> surfels, gone;
    surfels.reserve(inside.size());
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (distances[i] < e / 2 * (1 - kLanding)) {
            gone.push_back(inside[i]);
            continue;
        }
        surfels.push_back(inside[i]);
        if (distances[i] >= inside[i].radius) continue;
        surfels.back().radius = distances[i];
        ++counts.shrunk;
    }
    const std::size_t before = surfels.size();
    for (const EdgeCurve& curve : curves) append_curve(surfels, curve, curve.smooth ? curve.spacing : e);
    counts.on_edges = static_cast<Eigen::Index>(surfels.size() - before);
    hand_on_areas(gone, surfels, before);
    inside = std::move(surfels);
    return counts;
}

} // namespace fettle
