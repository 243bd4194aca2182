#include "machining/tilt.h"

#include "align/rigid.h"

#include <Eigen/Geometry>

#include <utility>

namespace fettle {

Eigen::Matrix3d rotation_tilted_machine(const Eigen::Vector3d& axis)
{
    constexpr double kUpsideDown = -1 + 1e-12; // there is no shortest way then
    if (axis.z() < kUpsideDown) return Eigen::Vector3d(1, -1, -1).asDiagonal();
    // I + [v] + [v]²/(1 + c) with v = axis × Z, c = axis · Z
    const Eigen::Vector3d v = axis.cross(Eigen::Vector3d::UnitZ());
    Eigen::Matrix3d cross;
    cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return Eigen::Matrix3d::Identity() + cross + cross * cross / (1 + axis.z());
}

Mesh turned(Mesh mesh, const Eigen::Matrix3d& rotation)
{
    if (!rotation.isIdentity(0)) mesh.vertices = (rotation * mesh.vertices).eval();
    return mesh;
}

Cloud turned(Cloud cloud, const Eigen::Matrix3d& rotation)
{
    if (rotation.isIdentity(0)) return cloud;
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = rotation;
    return moved(std::move(cloud), matrix, 1);
}

} // namespace fettle
