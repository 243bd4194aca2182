#pragma once

// The scanner of find-case: a part sampled at the cells of a grid, and the faults of a scan.

#include "find-case-anomalies.h"

#include "geometry/bounding_box.h"
#include "mesh/mesh_index.h"

#include <limits>

namespace find_case {

constexpr double kSteepSlope = 4.7; // 78°
constexpr double kSteepDropout = 0.7, kDropout = 0.003, kFlying = 0.0007;
constexpr double kFlyingSigmas = 30;
constexpr double kCorrelationCells = 3, kCorrelatedShare = 0.5;

/// White noise smoothed over some cells, of standard deviation 1.
inline Image correlated_noise(Random& random, cv::Size size)
{
    Image noise(size);
    for (float& value : noise) value = float(geometry::draw_normal(random, 1));
    cv::GaussianBlur(noise, noise, {}, kCorrelationCells, kCorrelationCells, cv::BORDER_REFLECT);
    return noise * (2 * kCorrelationCells * std::sqrt(pi));
}

/// What a scanner makes of a clean map.
inline Image scanned(const find::HeightMap& map, double sigma, Random& random)
{
    Image z = map.z + kCorrelatedShare * sigma * correlated_noise(random, map.z.size());
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x) {
            z(y, x) += float(geometry::draw_normal(random, sigma));
            const float dx = map.z(y, std::min(x + 1, z.cols - 1)) - map.z(y, std::max(x - 1, 0));
            const float dy = map.z(std::min(y + 1, z.rows - 1), x) - map.z(std::max(y - 1, 0), x);
            const bool is_steep = std::hypot(dx, dy) / (2 * map.cell) > kSteepSlope;
            if (geometry::draw_uniform(random) < (is_steep ? kSteepDropout : kDropout))
                z(y, x) = std::numeric_limits<float>::quiet_NaN();
            if (geometry::draw_uniform(random) < kFlying)
                z(y, x) += float(geometry::draw_normal(random, kFlyingSigmas * sigma));
        }
    const auto blocks = int(geometry::draw_index(random, 3));
    for (int k = 0; k < blocks; ++k) {
        // Statements are evaluated in their order, the arguments of a call in one that the compiler chooses.
        const auto row = int(geometry::draw_index(random, std::size_t(z.rows)));
        const auto column = int(geometry::draw_index(random, std::size_t(z.cols)));
        const cv::Point at(column, row);
        const int r = 1 + int(geometry::draw_index(random, 3));
        z(cv::Rect(at.x - r, at.y - r, 2 * r, 2 * r) & cv::Rect({0, 0}, z.size())).setTo(core::kNaN);
    }
    return z;
}

inline find::HeightMap sampled(const mesh::CloudMesh& part, double cell)
{
    const Eigen::AlignedBox3d box = geometry::bounding_box(part.points.xyz);
    find::HeightMap map;
    map.cell = cell;
    map.origin = box.min().head<2>().array() + cell / 2;
    map.z = Image(int(box.sizes().y() / cell), int(box.sizes().x() / cell));
    const mesh::Mesh mesh{part.points.xyz, part.triangles};
    const mesh::MeshIndex index(mesh);
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x) {
            const Vector2d p = map.point_at(x, y);
            const auto hit = index.highest(p.x(), p.y());
            map.z(y, x) = hit ? float(hit->point.z()) : std::numeric_limits<float>::quiet_NaN();
        }
    map.seen = find::finite(map.z);
    return map;
}

/// Points of a map's cells.
inline Eigen::Matrix3Xd points_of(const find::HeightMap& map)
{
    std::vector<Vector3d> points;
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x)
            if (std::isfinite(map.z(y, x))) {
                const Vector2d p = map.point_at(x, y);
                points.emplace_back(p.x(), p.y(), map.z(y, x));
            }
    return points.empty() ? Eigen::Matrix3Xd()
                          : Eigen::Map<Eigen::Matrix3Xd>(points[0].data(), 3, Index(points.size()));
}

/// Slow form: two waves of one half to one length over the part, of amplitude `size` together, mm.
inline double bend(const Vector2d& p, const Eigen::AlignedBox3d& box, double size, int number)
{
    const Vector2d share = (p - box.center().head<2>()) / box.sizes().head<2>().maxCoeff();
    Random random(0x9e3779b97f4a7c15U + std::uint64_t(number));
    double sum = 0;
    for (int k = 0; k < 2; ++k) {
        const double turn = draw_between(random, 0, 2 * pi), waves = draw_between(random, 0.5, 1),
                     phase = draw_between(random, 0, 2 * pi);
        sum += std::sin(2 * pi * waves * share.dot(Vector2d(std::cos(turn), std::sin(turn))) + phase) / 2;
    }
    return size * sum;
}

} // namespace find_case
