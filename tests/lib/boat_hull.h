#pragma once

#include "core/direction.h"
#include "mesh/mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <vector>

/// A boat's hull, keel up, 300 x 120 x 100 mm, and a ball-end tool along a raster over it.
namespace fettle::boat {

inline constexpr double kBall = 6; ///< radius

inline double height(double x, double y)
{
    const double u = x / 150, w = std::abs(y) / 60;
    return 100 * (1 - std::pow(w, 2.5)) * (1 - 0.85 * u * u * u * u) + 0.6 * std::sin(x / 9) * std::cos(y / 7);
}

/// About so many, in a grid of quads.
inline mesh::Mesh hull(int triangles)
{
    const int across = static_cast<int>(std::sqrt(triangles / 2 * 0.4)), along = triangles / 2 / across;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (along + 1) * (across + 1));
    mesh.triangles.resize(3, 2 * along * across);
    Eigen::Index v = 0, t = 0;
    for (int j = 0; j <= across; ++j)
        for (int i = 0; i <= along; ++i) {
            const double x = -150 + 300.0 * i / along, y = -60 + 120.0 * j / across;
            mesh.vertices.col(v++) << x, y, height(x, y);
        }
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < along; ++i) {
            const int a = j * (along + 1) + i, b = a + 1, c = a + along + 1, d = c + 1;
            mesh.triangles.col(t++) << a, b, d;
            mesh.triangles.col(t++) << a, d, c;
        }
    return mesh;
}

/// In 100 lines. The origin is the ball's centre, z the tool's axis, x as far as possible along x. The ball is 0.02 mm
/// clear, but for one pose of 20 that gouges 0.05 mm; the axis leans a fifth of the way to the normal.
inline std::vector<Eigen::Isometry3d> poses(int count)
{
    std::vector<Eigen::Isometry3d> all;
    constexpr int kLines = 100;
    const int per_line = count / kLines;
    for (int k = 0; k < count; ++k) {
        const int line = k / per_line, i = line % 2 == 0 ? k % per_line : per_line - 1 - k % per_line;
        const double x = -140 + 280 * (i + 0.5) / per_line, y = -54 + 108 * (line + 0.5) / kLines, e = 1e-4;
        const Eigen::Vector3d normal = Eigen::Vector3d((height(x - e, y) - height(x + e, y)) / (2 * e),
                                                       (height(x, y - e) - height(x, y + e)) / (2 * e), 1)
                                           .normalized();
        const Eigen::Vector3d axis = 0.2 * normal + 0.8 * Eigen::Vector3d::UnitZ();
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.translation() = Eigen::Vector3d(x, y, height(x, y)) + (kBall + (k % 20 == 7 ? -0.05 : 0.02)) * normal;
        T.linear() = core::rotation_between(Eigen::Vector3d::UnitZ(), axis);
        all.push_back(T);
    }
    return all;
}

} // namespace fettle::boat
