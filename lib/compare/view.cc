#include "compare/view.h"

#include <Eigen/Geometry>

namespace fettle {

using Eigen::Vector3d;

Eigen::Matrix3d view_rotation(const Vector3d& from)
{
    constexpr double kAlongZ = 1e-6; // nearer to Z, "up" is lost in rounding
    const bool along_z = from.head<2>().norm() < kAlongZ;
    const Vector3d right = (along_z ? Vector3d::UnitY() : Vector3d::UnitZ()).cross(from).normalized();
    Eigen::Matrix3d rotation;
    rotation << right.transpose(), from.cross(right).transpose(), from.transpose();
    return rotation;
}

Eigen::Matrix3Xd in_view(const Eigen::Matrix3d& rotation_view_machine, const Eigen::Matrix3Xd& points)
{
    const Eigen::Matrix3d& R = rotation_view_machine;
    Eigen::Matrix3Xd seen(3, points.cols());
    seen.topRows<2>().noalias() = R.topLeftCorner<2, 2>() * points.topRows<2>();
    if (!R.topRightCorner<2, 1>().isZero(0)) seen.topRows<2>().noalias() += R.topRightCorner<2, 1>() * points.row(2);
    seen.row(2).noalias() = R.row(2) * points;
    return seen;
}

} // namespace fettle
