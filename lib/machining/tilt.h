#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle::machining {

/// Rotation for machining with a tilted tool (3+2 axes): all geometry is rotated into the tilted frame T, whose +z is
/// the tool's axis and whose origin is that of M. It is the rotation with the smallest angle, about a horizontal axis;
/// about X for a tool that points straight down.
/// @param axis  tool axis from the tip to the holder, unit, frame M
/// @return  R with p_tilted = R · p_machine
Eigen::Matrix3d rotation_tilted_machine(const Eigen::Vector3d& axis);

/// Rotates all points and directions; the identity changes no bit.
mesh::Mesh rotated(mesh::Mesh mesh, const Eigen::Matrix3d& rotation);
cloud::Cloud rotated(cloud::Cloud cloud, const Eigen::Matrix3d& rotation);

} // namespace fettle::machining
