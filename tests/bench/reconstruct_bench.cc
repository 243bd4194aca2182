// Triangles from points in any order: fettle's Delaunay stars beside pcl::GreedyProjectionTriangulation (race.h).
//   area      of the triangles over that of the sphere: 1 if nothing is open, or covered twice
//   borders   edges of one triangle alone: 0 on a closed surface
//   folds     edges that two triangles go along in the same direction: one lies over the other, or is turned over

#include "race.h"

#include "cloud/pcl.h"
#include "reconstruct/stars.h"

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using namespace fettle;

namespace {

using Triangles = std::vector<Eigen::Vector3i>;

constexpr double kRadius = 50; // mm

/// Directions scattered evenly at random over the sphere.
Eigen::Matrix3Xd scattered_directions(Eigen::Index count)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    Eigen::Matrix3Xd directions(3, count);
    for (auto direction : directions.colwise()) {
        for (double& coordinate : direction) coordinate = normal(random);
        direction.normalize();
    }
    return directions;
}

/// PCL's triangulation; its tutorial's bounds on angles, made for even points, would leave a quarter open.
Triangles greedy_projection(const Eigen::Matrix3Xd& xyz, const Eigen::Matrix3Xd& normals, double max_gap)
{
    const auto cloud = cloud::to_pcl(xyz, normals, Eigen::Vector3d::Zero());
    pcl::GreedyProjectionTriangulation<pcl::PointNormal> greedy;
    greedy.setSearchRadius(max_gap);
    greedy.setMu(5);
    greedy.setMaximumNearestNeighbors(100);
    greedy.setMaximumSurfaceAngle(std::numbers::pi / 3);
    greedy.setMinimumAngle(0);
    greedy.setMaximumAngle(std::numbers::pi);
    greedy.setNormalConsistency(true);
    greedy.setInputCloud(cloud);
    greedy.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
    std::vector<pcl::Vertices> polygons;
    greedy.reconstruct(polygons);
    Triangles triangles;
    for (const pcl::Vertices& polygon : polygons)
        triangles.emplace_back(int(polygon.vertices[0]), int(polygon.vertices[1]), int(polygon.vertices[2]));
    return triangles;
}

struct Quality {
    double area = 0, borders = 0, folds = 0;
};

Quality quality_of(const Triangles& triangles, const Eigen::Matrix3Xd& xyz)
{
    Quality quality;
    std::map<std::pair<int, int>, int> edges; // as triangles go along them
    for (const Eigen::Vector3i& t : triangles) {
        const Eigen::Vector3d a = xyz.col(t[0]), b = xyz.col(t[1]), c = xyz.col(t[2]);
        quality.area += (b - a).cross(c - a).norm() / 2 / (4 * std::numbers::pi * kRadius * kRadius);
        for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
        quality.borders += count == 1 && !edges.contains({edge.second, edge.first});
        quality.folds += count > 1;
    }
    return quality;
}

/// @param state  number of points; largest gap in spacings
void stars_by_greedy_projection(benchmark::State& state)
{
    const Eigen::Matrix3Xd normals = scattered_directions(state.range(0)), xyz = kRadius * normals;
    const double spacing = kRadius * std::sqrt(4 * std::numbers::pi / double(state.range(0)));
    const double max_gap = double(state.range(1)) * spacing;
    Triangles ours, theirs;
    race(
        state, [&] { return (ours = reconstruct::star_triangles(xyz, normals, max_gap)).size(); },
        [&] { return (theirs = greedy_projection(xyz, normals, max_gap)).size(); });
    const Quality our_quality = quality_of(ours, xyz), their_quality = quality_of(theirs, xyz);
    state.counters["ours_area"] = our_quality.area;
    state.counters["library_area"] = their_quality.area;
    state.counters["ours_borders"] = our_quality.borders;
    state.counters["library_borders"] = their_quality.borders;
    state.counters["ours_folds"] = our_quality.folds;
    state.counters["library_folds"] = their_quality.folds;
}
BENCHMARK(stars_by_greedy_projection)
    ->Args({20'000, 3})
    ->Args({20'000, 6})
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);

} // namespace
