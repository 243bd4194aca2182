#pragma once

#include "robot/robot.h"

#include "json/document.h"

// How the parts of a robot file are read; for robot.cc.
namespace fettle {

// 100 m: no cell is larger, and a length in another unit shows.
inline constexpr double kLongest = 1e5;

/// A length, mm. @throws InputError beyond kLongest
double length_in(json::Reader& reader, const std::string& key, double mm);
/// @throws InputError as length_in
Eigen::Vector3d point_in(json::Reader& reader, const std::string& key, double mm);
/// A unit vector. @throws InputError if its length is 0
Eigen::Vector3d direction_in(json::Reader& reader, const std::string& key);
/// "position" [x, y, z] and "quaternion" [w, x, y, z], both of which may be left out.
Eigen::Isometry3d placement_in(json::Reader reader, double mm);

/// "bodies", "allowed" and "margins".
/// @param path  of the robot file: hulls lie beside it
void parse_bodies(json::Reader& reader, const std::string& path, double mm, Robot& robot);

} // namespace fettle
