#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Points that were picked on a scan in a viewer, in the order of picking, in the scan's unit.
/// CloudCompare's saved list: a line each, "x,y,z", with index or label before. What pcd_viewer says when points are
/// picked (shift and click): lines "Point index picked: … - [x, y, z]" among others.
/// @throws InputError with the line that is none, or if there are none
Eigen::Matrix3Xd read_picked(const std::string& path);
Eigen::Matrix3Xd parse_picked(std::string_view bytes, const std::string& source);

} // namespace fettle
