#pragma once

#include "cloud/poses.h"
#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/robot.h"

namespace fettle {

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
