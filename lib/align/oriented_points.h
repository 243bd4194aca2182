#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// Points of a surface, each with the direction across it.
struct OrientedPoints {
    Eigen::Matrix3Xd xyz;     ///< mm, finite
    Eigen::Matrix3Xd normals; ///< unit; zero where the surface has no direction
};

/// The points of a cloud that are there; its normals, or where it has none, those of the planes through the nearest
/// points, on no particular side.
OrientedPoints oriented_points(const Cloud& cloud);

/// Points spread evenly over a mesh's facets, by a low-discrepancy sequence; none, if it has no area.
/// @param count  20000: as many as a fine scan of a part has
OrientedPoints oriented_points(const Mesh& mesh, Eigen::Index count = 20000);

/// Columns of `count` points (all, if there are fewer) that cover the others as evenly as can be: each is the one
/// farthest from those before it, the first farthest from the middle (Gonzalez 1985). A rigid motion changes nothing.
/// @param points  3xN, finite
std::vector<Eigen::Index> farthest_points(const Eigen::Matrix3Xd& points, Eigen::Index count);

/// Columns of `count` points (all, if there are fewer) evenly through their order.
std::vector<Eigen::Index> every_nth(Eigen::Index points, Eigen::Index count);

} // namespace fettle
