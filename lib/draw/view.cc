#include "draw/view.h"

#include <Eigen/Geometry>

namespace fettle::draw {

using Eigen::Vector3d;

Eigen::Matrix3d view_rotation(const Vector3d& towards_eye)
{
    constexpr double kMinHorizontal = 1e-6; // below it, "up" is lost in rounding
    const bool along_z = towards_eye.head<2>().norm() < kMinHorizontal;
    const Vector3d right = (along_z ? Vector3d::UnitY() : Vector3d::UnitZ()).cross(towards_eye).normalized();
    Eigen::Matrix3d rotation;
    rotation << right.transpose(), towards_eye.cross(right).transpose(), towards_eye.transpose();
    return rotation;
}

Eigen::Matrix3Xd in_view(const Eigen::Matrix3d& rotation_view_machine, const Eigen::Matrix3Xd& points)
{
    const Eigen::Matrix3d& R = rotation_view_machine;
    Eigen::Matrix3Xd view(3, points.cols());
    view.topRows<2>().noalias() = R.topLeftCorner<2, 2>() * points.topRows<2>();
    if (!R.topRightCorner<2, 1>().isZero(0)) view.topRows<2>().noalias() += R.topRightCorner<2, 1>() * points.row(2);
    view.row(2).noalias() = R.row(2) * points;
    return view;
}

} // namespace fettle::draw
