#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle {

/// Machining with a tilted tool (3+2 axes): everything is turned into the tilted frame T, where the tool's axis points
/// up; the origin stays. M is turned the shortest way, about an axis that is level; a tool that points straight down
/// about X.
/// @param axis  of the tool, from its tip to its holder, unit, M
/// @return  p_tilted = R · p_machine
Eigen::Matrix3d rotation_tilted_machine(const Eigen::Vector3d& axis);

/// All places and directions turned; the identity changes no bit.
Mesh turned(Mesh mesh, const Eigen::Matrix3d& rotation);
Cloud turned(Cloud cloud, const Eigen::Matrix3d& rotation);

} // namespace fettle
