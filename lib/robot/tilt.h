#pragma once

#include "robot/robot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle {

/// How a pose is changed: the tool leans about a pivot on its axis, then it moves away.
struct PoseChange {
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero(); ///< x and y of the rotation vector, tool frame, rad; no twist
    double retreat = 0;                             ///< mm

    bool operator==(const PoseChange&) const = default;
};

/// The point of the tool's axis that stays when it leans, as a height above the tip, mm: the centre of a ball end (a
/// sphere, or a capsule's end, on the tool that has its lowest point at the tip), else the tip. A ball that turns about
/// its centre stays where it is, and so does the point where it touches the workpiece, whatever the surface's normal.
double tilt_pivot(const Robot& robot);

/// @param pivot  tilt_pivot()
/// @param away  unit, part frame: where a retreat leads
Eigen::Isometry3d changed_pose(const Eigen::Isometry3d& T_part_tool, const PoseChange& change, double pivot,
                               const Eigen::Vector3d& away);

/// The angle between two tilts as turns in space, rad.
double tilt_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

} // namespace fettle
