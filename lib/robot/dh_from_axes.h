#pragma once

#include "robot/robot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

namespace fettle::robot {

/// The axis of a revolute joint with all joints at 0, base frame.
struct JointAxis {
    Eigen::Vector3d point;     ///< mm
    Eigen::Vector3d direction; ///< unit: the joint turns right-handed about it
};

/// A Denavit-Hartenberg table for six axes.
struct DhFromAxes {
    std::array<DhRow, 6> dh; ///< alpha, a, d, offset and sign; no ranges
    ArmKind kind = ArmKind::general;
    Eigen::Isometry3d T_base_0; ///< frame 0 of the table in the frame of the axes
};

/// The table whose frames 0 to 5 have their z on the axes, x on the common normals (Denavit & Hartenberg 1955; Craig,
/// Introduction to robotics, 3); frame 6 is frame 5 turned by joint 6. With parallel axes the normal runs through the
/// origin of the frame before. Axes 2 and 3, and 4 if it is parallel, too, have one direction of z, so that a joint
/// that turns against it has the sign -1.
/// @throws InputError if two successive axes coincide, with the joints' numbers
DhFromAxes dh_from_axes(const std::array<JointAxis, 6>& axes);

} // namespace fettle::robot
