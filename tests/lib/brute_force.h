#pragma once

#include "core/direction.h"
#include "mesh/mesh.h"
#include "mesh/triangle.h"
#include "robot/solid.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

/// Collisions of spheres and cylinders with triangles one by one, by clipping: nothing of it is shared with the
/// library.
namespace fettle {

inline Triangle triangle_of(const Mesh& mesh, Eigen::Index index)
{
    Triangle t;
    for (int k = 0; k < 3; ++k) t.col(k) = mesh.vertices.col(mesh.triangles(k, index));
    return t;
}

/// Is a point of the triangle between the two heights nearer to the z axis than the radius?
inline bool reaches_into_cylinder(const Triangle& t, double from, double to, double radius)
{
    std::array<Eigen::Vector3d, 9> in = {t.col(0), t.col(1), t.col(2)}, out;
    std::size_t count = 3;
    for (const auto& [sign, bound] : {std::pair(1.0, from), std::pair(-1.0, -to)}) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Vector3d &p = in[i], &q = in[(i + 1) % count];
            const double above_p = sign * p.z() - bound, above_q = sign * q.z() - bound;
            if (above_p >= 0) out[kept++] = p;
            if ((above_p > 0 && above_q < 0) || (above_p < 0 && above_q > 0))
                out[kept++] = p + above_p / (above_p - above_q) * (q - p);
        }
        in = out;
        count = kept;
        if (count == 0) return false;
    }
    bool left = false, right = false;
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector2d p = in[i].head<2>(), way = in[(i + 1) % count].head<2>() - p;
        const double length2 = way.squaredNorm();
        const double s = length2 > 0 ? std::clamp(-p.dot(way) / length2, 0.0, 1.0) : 0;
        if ((p + s * way).squaredNorm() < radius * radius) return true;
        const double side = p.x() * way.y() - p.y() * way.x();
        left |= side > 0;
        right |= side < 0;
    }
    return count > 2 && left != right;
}

/// Does any triangle reach deeper than that into the sphere or cylinder? Deeper than d are the points of one that is
/// smaller by d all around.
inline bool any_deeper(const Mesh& mesh, const Solid& solid, const Eigen::Isometry3d& T, double depth)
{
    const auto* cylinder = std::get_if<solid::Cylinder>(&solid);
    const auto* sphere = std::get_if<solid::Sphere>(&solid);
    const Eigen::Vector3d from = T * (cylinder ? cylinder->from : sphere->centre);
    const Eigen::Vector3d way = cylinder ? Eigen::Vector3d(T * cylinder->to - from) : Eigen::Vector3d::Zero();
    const double length = way.norm(), radius = (cylinder ? cylinder->radius : sphere->radius) - depth;
    const Eigen::Vector3d middle = from + way / 2;
    const double around = std::hypot(length / 2, radius);
    const Eigen::Matrix3d turn = turn_between(cylinder ? way : Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ());
    for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
        const Triangle t = triangle_of(mesh, i);
        if (((t.colwise() - middle).rowwise().minCoeff().array() > around).any() ||
            ((t.colwise() - middle).rowwise().maxCoeff().array() < -around).any())
            continue;
        if (sphere != nullptr) {
            if (closest_on_triangle(t, from).squared_distance < radius * radius) return true;
        } else if (reaches_into_cylinder(turn * (t.colwise() - from), depth, length - depth, radius)) {
            return true;
        }
    }
    return false;
}

} // namespace fettle
