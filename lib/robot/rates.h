#pragma once

#include "robot/externals.h"
#include "robot/follow.h"

#include <Eigen/Core>

#include <numbers>
#include <vector>

namespace fettle {

/// Speeds of the tool along its path, in the part.
struct Feedrate {
    double tip = 0;                             ///< mm/s
    double turn = 500 * std::numbers::pi / 180; ///< rad/s: what RAPID's own speeds (v5 to v7000) have
};

/// When each pose is reached: the tip goes at the feed, and where the tool turns faster than it may, slower. From 0,
/// s; a pose without a place takes no time.
Eigen::VectorXd arrival_times(const PosePath& poses, const Feedrate& feed);

/// Rates of one joint along a path; rad/s and rad/s², of the track mm/s and mm/s².
struct JointRate {
    double speed = 0, acceleration = 0;               ///< the largest, without sign
    Eigen::Index speed_at = -1, acceleration_at = -1; ///< the pose that the fastest motion leads to; the pose
    Eigen::Index too_fast = 0;                        ///< motions faster than the robot's max_speed
};

/// By differences between neighbouring poses that are both reached without a jump, and of these about the pose between
/// them. No time between two places that differ is infinite speed.
/// @param times  of each pose, s, not descending
std::array<JointRate, 8> joint_rates(const Robot& robot, const FollowedPath& path, const Eigen::VectorXd& times);

} // namespace fettle
