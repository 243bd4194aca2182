#pragma once

#include "cloud/cloud.h"
#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <string>

namespace fettle::robot {

/// Texts of the command-line options for the kinematics of a path.
struct PathArguments {
    std::string track = "auto", table = "auto"; ///< see parse_axis_rule()
    std::string start = "0,0,0,0,0,0";          ///< joints, degrees
    double jump_threshold_deg = 30;             ///< FollowOptions::jump_threshold, degrees
};

/// Poses of a path with the joints that reach them.
struct SolvedPath {
    cloud::PosePath poses;
    ExternalChoice externals;
    Eigen::Matrix2Xd external_values; ///< 2xN
    FollowedPath path;
};

/// @throws InputError for a rule or a start that cannot be read, and for a rule of an axis that the robot lacks
void check_arguments(const Robot& robot, const PathArguments& arguments, double mm);

/// Finds joints for the poses of a cloud, see cloud::read_poses().
/// @param mm  in the length unit of the options
/// @param is_clear  see choose_externals()
/// @throws InputError if there are no points, or for an option, then starting with its name
SolvedPath path_from_poses(const Robot& robot, const cloud::Cloud& cloud, const PathArguments& options, double mm,
                           const IsClear& is_clear = {});

/// Finds the poses for the joints of a cloud, see path_joints(). `externals` is not set.
/// @throws InputError if there are no points, or a field is missing
SolvedPath path_from_joints(const Robot& robot, const cloud::Cloud& cloud, double jump_deg);

/// Finds joints for the poses of a cloud, or the poses for its joints if it has these. @throws as both functions above
SolvedPath solve_path(const Robot& robot, const cloud::Cloud& cloud, const PathArguments& options, double mm,
                      const IsClear& is_clear = {});

/// Every solution of every pose: the points of the path, repeated, with the fields of the joints, pose and branch.
cloud::Cloud all_solutions(const Robot& robot, const cloud::Cloud& cloud, const SolvedPath& solved);

} // namespace fettle::robot
