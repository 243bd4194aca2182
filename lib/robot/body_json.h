#pragma once

#include "robot/robot.h"

#include "mesh/mesh.h"
#include "json/document.h"

// Readers for the parts of a robot file, used by robot.cc. `mm` is the file's length unit in mm.
namespace fettle::robot {

/// Bound of all lengths in a robot file, mm: no cell is larger than 100 m, so a wrong length unit is noticed.
inline constexpr double kMaxLength = 1e5;

/// Reads a length. @return  mm @throws InputError beyond kMaxLength
double read_length(json::Reader& reader, const std::string& key, double mm);
/// Reads three coordinates. @return  mm @throws InputError beyond kMaxLength
Eigen::Vector3d read_point(json::Reader& reader, const std::string& key, double mm);
/// Reads a vector and normalises it. @throws InputError if its length is 0
Eigen::Vector3d read_direction(json::Reader& reader, const std::string& key);
/// Reads "position" [x, y, z] and "quaternion" [w, x, y, z] of any length but 0; both are optional.
Eigen::Isometry3d read_placement(json::Reader reader, double mm);

/// Reads the mesh of a body whole. @throws InputError if a facet would be left out: the body would be smaller
mesh::Mesh read_body_mesh(const std::string& path, units::Units::Length unit);

/// Reads "bodies", "allowed", "margins" and "calibration_error" into `robot`.
/// @param path  of the robot file; the mesh files of hulls are relative to its folder
void parse_bodies(json::Reader& reader, const std::string& path, double mm, Robot& robot);

} // namespace fettle::robot
