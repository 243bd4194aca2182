#pragma once

#include "robot/robot.h"

#include <string>
#include <vector>

namespace fettle::robot {

/// Adds the pairs of links that an SRDF lets touch (disable_collisions) to Robot::allowed.
/// @param links  of the robot's bodies, by body
/// @throws InputError if the file is no SRDF, or a pair lacks a link. Links without a body are no error.
void read_srdf(const std::string& path, const std::vector<std::string>& links, Robot& robot);

} // namespace fettle::robot
