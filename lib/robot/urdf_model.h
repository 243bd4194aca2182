#pragma once

#include "robot/robot.h"
#include "robot/urdf.h"

#include <string>

namespace urdf {
class ModelInterface;
} // namespace urdf

namespace fettle::robot {

/// The robot of a URDF that liburdfdom has read (urdf.h says what becomes of it).
/// @param source  name of the file; meshes without a package are relative to its folder
/// @throws InputError for loops, another number of joints, joints without limits or axis, and meshes that are missing
/// or of another format
Robot make_robot(const urdf::ModelInterface& model, const std::string& source, const UrdfOptions& options);

} // namespace fettle::robot
