#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle::job {

/// Points picked on a scan in a viewer, 3xN, in the order of picking, in the scan's unit. Either CloudCompare's picking
/// list, lines "x,y,z" with index or label first, or the output of pcd_viewer, in which the lines "Point index picked:
/// … - [x, y, z]" count and others are skipped.
/// @throws InputError that names a malformed line, or if there are no points
Eigen::Matrix3Xd read_picked_points(const std::string& path);
Eigen::Matrix3Xd parse_picked_points(std::string_view bytes, const std::string& source);

} // namespace fettle::job
