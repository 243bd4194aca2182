#pragma once

#include "robot/externals.h"
#include "robot/follow.h"

#include <Eigen/Core>

#include <numbers>

namespace fettle::robot {

/// Speed limits of the tool along its path, relative to the part.
struct Feedrate {
    double tip_speed = 0;                            ///< mm/s
    double turn_rate = 500 * std::numbers::pi / 180; ///< rad/s: the value of RAPID's predefined speeds (v5 to v7000)
};

/// Times at which the poses are reached, s, from 0: the tip moves at its feed, or slower where the tool would turn too
/// fast. The motions to and from a NaN pose take no time.
Eigen::VectorXd arrival_times(const cloud::PosePath& poses, const Feedrate& feed);
/// Arrival times with a speed of the tip for the motion to each pose. @param speeds  N, mm/s   @param turn_rate  rad/s
Eigen::VectorXd arrival_times(const cloud::PosePath& poses, const Eigen::VectorXd& speeds, double turn_rate);
/// Arrival times where the speeds are along other ways than the tip's. @param lengths  N, of the motion to each pose,
/// mm
Eigen::VectorXd arrival_times(const cloud::PosePath& poses, const Eigen::VectorXd& lengths,
                              const Eigen::VectorXd& speeds, double turn_rate);

/// Way of the tip to each pose, mm; 0 to the first, and NaN to and from a NaN pose.
Eigen::VectorXd tip_ways(const cloud::PosePath& poses);

/// Largest speed and acceleration of one joint along a path; rad/s and rad/s² (track: mm/s and mm/s²).
struct JointRate {
    double speed = 0, acceleration = 0;               ///< maximum magnitude
    Eigen::Index speed_at = -1, acceleration_at = -1; ///< the pose at the end of the fastest motion; the pose
    Eigen::Index over_limit_count = 0;                ///< number of motions faster than the robot's max_speed
    Eigen::Index first_over_limit = -1;               ///< the pose at the end of the first of them
};

/// Finite differences: speeds between neighbouring poses that are both reached without a jump, and accelerations
/// between neighbouring speeds. A motion that takes no time has infinite speed.
/// @param times  of the poses, s, not decreasing
std::array<JointRate, 8> joint_rates(const Robot& robot, const FollowedPath& path, const Eigen::VectorXd& times);

} // namespace fettle::robot
