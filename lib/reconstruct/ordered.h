#pragma once

#include "cloud/profiles.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::reconstruct {

/// Triangles along the order of points, all counter-clockwise seen from the same side, unknown which; of any size.
struct OrderedTriangles {
    std::vector<Eigen::Vector3i> triangles;
    double spacing = 0; ///< median distance of neighbours in the direction in which they lie farther apart, mm
};

/// Triangles of an organised cloud: two in each square of the grid, cut along the shorter diagonal, or one where a
/// corner is missing (pcl::OrganizedFastMesh, which is float, does the same with its adaptive cut).
/// @param xyz  3xN, mm; NaN: no point   @param width  of the grid
OrderedTriangles grid_triangles(const Eigen::Matrix3Xd& xyz, Eigen::Index width);

/// Triangles between neighbouring profiles. Points that run back along their profile (reflections, and what lies
/// beneath an overhang) are left out, so that no triangle folds over another.
/// @param xyz  3xN, mm, finite
OrderedTriangles profile_triangles(const Eigen::Matrix3Xd& xyz, const cloud::Profiles& profiles);

} // namespace fettle::reconstruct
