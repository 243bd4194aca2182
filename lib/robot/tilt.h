#pragma once

#include "robot/robot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle::robot {

/// A change of a pose: the tool tilts about a pivot on its axis, then it retreats from the part.
struct PoseChange {
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero(); ///< x and y of the rotation vector, tool frame, rad; its z is 0
    double retreat = 0;                             ///< mm

    bool operator==(const PoseChange&) const = default;
};

/// The fixed point of tilts on the tool's axis, as a height above the tip, mm: the centre of a ball end (a sphere or a
/// capsule's end on the tool with its lowest point at the tip), else the tip. A ball that turns about its centre keeps
/// its point of contact with the workpiece, whatever the surface's normal.
double tilt_pivot(const Robot& robot);

/// The pose after a change.
/// @param pivot  see tilt_pivot()
/// @param retreat_direction  unit, part frame
Eigen::Isometry3d changed_pose(const Eigen::Isometry3d& T_part_tool, const PoseChange& change, double pivot,
                               const Eigen::Vector3d& retreat_direction);

/// The angle of the rotation from one tilt to another, rad.
double tilt_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

} // namespace fettle::robot
