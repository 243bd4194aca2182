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

/// Is a point of the triangle between the two heights nearer to the z axis than the radius?
inline bool reaches_into_cylinder(const mesh::Triangle& t, double from, double to, double radius)
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
        const Eigen::Vector2d p = in[i].head<2>(), step = in[(i + 1) % count].head<2>() - p;
        const double length2 = step.squaredNorm();
        const double s = length2 > 0 ? std::clamp(-p.dot(step) / length2, 0.0, 1.0) : 0;
        if ((p + s * step).squaredNorm() < radius * radius) return true;
        const double side = p.x() * step.y() - p.y() * step.x();
        left |= side > 0;
        right |= side < 0;
    }
    return count > 2 && left != right;
}

/// Does any triangle reach deeper than that into the sphere or cylinder? Deeper than d are the points of one that is
/// smaller by d all around.
inline bool any_deeper(const mesh::Mesh& mesh, const robot::Solid& solid, const Eigen::Isometry3d& T, double depth)
{
    const auto* cylinder = std::get_if<robot::solid::Cylinder>(&solid);
    const auto* sphere = std::get_if<robot::solid::Sphere>(&solid);
    const Eigen::Vector3d from = T * (cylinder ? cylinder->from : sphere->centre);
    const Eigen::Vector3d step = cylinder ? Eigen::Vector3d(T * cylinder->to - from) : Eigen::Vector3d::Zero();
    const double length = step.norm(), radius = (cylinder ? cylinder->radius : sphere->radius) - depth;
    const Eigen::Vector3d middle = from + step / 2;
    const double around = std::hypot(length / 2, radius);
    const Eigen::Matrix3d turn =
        core::rotation_between(cylinder ? step : Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ());
    for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
        const mesh::Triangle t = triangle_of(mesh, i);
        if (((t.colwise() - middle).rowwise().minCoeff().array() > around).any() ||
            ((t.colwise() - middle).rowwise().maxCoeff().array() < -around).any())
            continue;
        if (sphere != nullptr) {
            if (mesh::closest_on_triangle(t, from).squared_distance < radius * radius) return true;
        } else if (reaches_into_cylinder(turn * (t.colwise() - from), depth, length - depth, radius)) {
            return true;
        }
    }
    return false;
}

} // namespace fettle
