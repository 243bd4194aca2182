#pragma once

#include "robot/follow.h"
#include "robot/rates.h"
#include "units/units.h"
#include "json/document.h"

#include <optional>
#include <string>

namespace fettle::robot {

/// Adds to a report the counts of poses by state, the jumps, the distance from singularities, and for each joint its
/// smallest and largest value, with times also its largest speed and acceleration. Angles in degrees, lengths in
/// `units`.
/// @param singularity_threshold  poses nearer to a singularity (Singularity::min) are counted
/// @param times  at which the poses are reached, s; without them no speeds and accelerations are reported
/// @return  true if the robot can run the path: all poses are reached, there is no jump, and no joint is too fast
bool add_report(json::Value& report, const Robot& robot, const FollowedPath& path, double singularity_threshold,
                const std::optional<Eigen::VectorXd>& times, const units::Units& units);

/// Why a robot cannot run a path: the first pose in the way, with the joint and the reason ("pose 3: joint 5
/// would be at 121 degrees, out of its range of -115 to 115"); empty if it can.
std::string path_obstacle(const Robot& robot, const FollowedPath& path, const std::optional<Eigen::VectorXd>& times);

/// Adds the rules of track and table, where the robot has them, as {"follows": …, "value": …}; degrees and `units`.
void add_report(json::Value& report, const Robot& robot, const ExternalChoice& externals, const units::Units& units);

} // namespace fettle::robot
