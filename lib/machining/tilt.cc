#include "machining/tilt.h"

#include <Eigen/Geometry>

#include <utility>

namespace fettle::machining {

Eigen::Matrix3d rotation_tilted_machine(const Eigen::Vector3d& axis)
{
    constexpr double kMinAxisZ = -1 + 1e-12; // below it the rotation axis is undefined
    if (axis.z() < kMinAxisZ) return Eigen::Vector3d(1, -1, -1).asDiagonal();
    // I + [v] + [v]²/(1 + c) with v = axis × Z, c = axis · Z
    const Eigen::Vector3d v = axis.cross(Eigen::Vector3d::UnitZ());
    Eigen::Matrix3d cross;
    cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return Eigen::Matrix3d::Identity() + cross + cross * cross / (1 + axis.z());
}

mesh::Mesh rotated(mesh::Mesh mesh, const Eigen::Matrix3d& rotation)
{
    if (!rotation.isIdentity(0)) mesh.vertices = (rotation * mesh.vertices).eval();
    return mesh;
}

cloud::Cloud rotated(cloud::Cloud cloud, const Eigen::Matrix3d& rotation)
{
    if (rotation.isIdentity(0)) return cloud;
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = rotation;
    return cloud::transformed(std::move(cloud), matrix, 1);
}

} // namespace fettle::machining
