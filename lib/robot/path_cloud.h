#pragma once

#include "cloud/poses.h"
#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <optional>

namespace fettle::robot {

/// Reads the fields joint1 to joint6 (degrees), and joint7 (track, mm) and joint8 (table, degrees) if the robot has
/// them.
/// @return  rad and mm; a column of NaN where a value is not finite
/// @throws InputError if one of them is missing, or beyond what a robot file allows (kMaxJointDegrees, kMaxLength)
CellJointsPath path_joints(const cloud::Cloud& cloud, const Robot& robot);

/// Sets these fields, as doubles; only those that the robot has.
void set_joints(cloud::Cloud& cloud, const Robot& robot, const CellJointsPath& joints);

/// Sets the fields state (PoseState) and singularity.
void set_states(cloud::Cloud& cloud, const FollowedPath& path);

/// The field t, s: when the poses are reached; nothing if there is none.
std::optional<Eigen::VectorXd> pose_times(const cloud::Cloud& cloud);

/// Forward kinematics of a path. @return  T_part_tool; a NaN translation for NaN joints
cloud::PosePath forward_kinematics(const Robot& robot, const CellJointsPath& joints);

} // namespace fettle::robot
