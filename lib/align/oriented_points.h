#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::align {

/// Surface points with normals, as pcl::PointNormal but in double.
struct OrientedPoints {
    Eigen::Matrix3Xd xyz;     ///< mm, finite
    Eigen::Matrix3Xd normals; ///< unit; zero where the surface has no direction
    bool outward = false;     ///< the normals point out of the material
};

/// The finite points of a cloud with its normals, which are taken for outward. A cloud without normals gets those of
/// planes fitted to the nearest points, on the side of the viewpoint; where that is unknown all on one side of the
/// surface, that from which most of it is convex.
OrientedPoints oriented_points(const cloud::Cloud& cloud);

/// Samples a mesh evenly by area with a low-discrepancy sequence; a mesh without area has no samples.
/// @param count  20000: as many as a fine scan of a part has
OrientedPoints oriented_points(const mesh::Mesh& mesh, Eigen::Index count = 20000);

/// Farthest point sampling (Gonzalez 1985): each sample is the point farthest from all samples before it, the first is
/// the point farthest from the centroid. A rigid motion of the points does not change the choice.
/// @param points  3xN, finite   @return  columns of min(count, N) points
std::vector<Eigen::Index> farthest_point_sample(const Eigen::Matrix3Xd& points, Eigen::Index count);

/// min(size, count) ascending indices, one from each of equal parts of 0 … size - 1, at a place in it by the golden
/// ratio: equal steps would choose the same few columns of an organised scan.
std::vector<Eigen::Index> scattered_indices(Eigen::Index size, Eigen::Index count);

} // namespace fettle::align
