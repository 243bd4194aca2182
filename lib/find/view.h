#pragma once

#include "find/height_map.h"
#include "mesh/cloud_mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace fettle::find {

/// A rigid motion of the part after which it is looked at from +z.
using View = Eigen::Isometry3d; // T_view_part

/// Directions from which nearly all of a part's surface is seen at no more than 60° from its normal: +z first, if
/// something is seen from there, then the direction from which most of the rest is seen, and so on (a greedy set
/// cover). A scan from one side has one view.
/// @throws InputError if the part has no surface: fewer than three finite points, or all on a line
std::vector<View> choose_views(const mesh::CloudMesh& part);

/// The heights of what is seen from a view, uncleaned. Of a cloud each cell has the median of its uppermost points; a
/// mesh is sampled at the cells' centres. The cell follows from the spacing of the points in the view's plane.
HeightMap height_map(const mesh::CloudMesh& part, const View& view);

} // namespace fettle::find
