#pragma once

#include "align/oriented_points.h"

#include <Eigen/Geometry>

#include <vector>

namespace fettle::align {

/// Poses of a scan on its reference by point pair features (Drost et al., Model globally, match locally, CVPR 2010).
/// Pairs of points of the larger one vote for the poses in which the smaller one has an equal pair: same distance, same
/// angles of the normals. Each pair votes independently of its surroundings, so that a small object in a scene and a
/// part that was scanned in part only are found, too.
/// @return  T_reference_scan, the pose with the most votes first; good to some 6°
std::vector<Eigen::Isometry3d> match_point_pairs(const OrientedPoints& scan, const OrientedPoints& reference);

} // namespace fettle::align
