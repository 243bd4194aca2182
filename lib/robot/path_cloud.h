#pragma once

#include "cloud/cloud.h"
#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/robot.h"

namespace fettle {

/// Poses of a path: x y z (mm) and the quaternion qw qx qy qz, of any length but 0. NaN: no pose.
/// @throws InputError if a field is missing, or a quaternion is 0
PosePath path_poses(const Cloud& cloud);

/// x y z and qw qx qy qz (unit, qw not negative, F8); other fields stay.
void set_path(Cloud& cloud, const PosePath& poses);

/// Fields joint1 to joint6 in degrees, joint7 (track, mm) and joint8 (table, degrees) if the robot has them.
/// @return  rad and mm; a column of NaN where one is not finite
/// @throws InputError if one of them is missing
CellJointsPath path_joints(const Cloud& cloud, const Robot& robot);

/// The same fields, F8; only those that the robot has.
void set_joints(Cloud& cloud, const Robot& robot, const CellJointsPath& joints);

/// Fields state (PoseState) and singularity.
void set_states(Cloud& cloud, const FollowedPath& path);

/// Where joints take the tool: T_part_tool.
PosePath forward(const Robot& robot, const CellJointsPath& joints);

} // namespace fettle
