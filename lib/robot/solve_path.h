#pragma once

#include "cloud/cloud.h"
#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

/// What a command line says about how a path is to be run, as it stands there.
struct PathWishes {
    std::string track = "auto", table = "auto"; ///< parse_axis_rule()
    std::string start = "0,0,0,0,0,0";          ///< degrees
    double jump_deg = 30;
};

/// Poses of a path, and how the robot runs along them.
struct SolvedPath {
    PosePath poses;
    ExternalChoice externals;
    Eigen::Matrix2Xd external_values; ///< 2xN
    FollowedPath path;
};

/// From the fields of path_poses() to joints. @param mm  in a length unit of the wishes
/// @throws InputError if there are no points, or for a wish, with the option's name before it
SolvedPath solve_path(const Robot& robot, const Cloud& cloud, const PathWishes& wishes, double mm);

/// From the fields of path_joints() to poses.
/// @throws InputError if there are no points, or a field is missing
SolvedPath given_path(const Robot& robot, const Cloud& cloud, double jump_deg);

/// Numbers with commas between; NaN for what is none.
Eigen::VectorXd numbers_in(const std::string& text);

} // namespace fettle
