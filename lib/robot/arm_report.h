#pragma once

#include "robot/follow.h"
#include "robot/rates.h"
#include "units/units.h"
#include "json/document.h"

#include <optional>

namespace fettle {

/// Adds counts of poses by state, jumps, distance from singularities, and for each joint its extent on the path; with
/// times, its largest speed and acceleration. Angles in degrees, lengths in `units`.
/// @param singular  poses nearer to a singularity are counted
/// @param times  of the poses, s; nothing: no rates
/// @return  can the robot run the path: all poses reached, no jump, no joint too fast?
bool add_report(json::Value& report, const Robot& robot, const FollowedPath& path, double singular,
                const std::optional<Eigen::VectorXd>& times, const Units& units);

/// {"follows": …, "value": …}. @param unit  rad in a degree, or mm in a length unit
json::Value to_json(const AxisRule& rule, double unit);

} // namespace fettle
