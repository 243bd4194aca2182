#pragma once

#include "align/rigid.h"
#include "geometry/point_index.h"
#include "merge/voxels.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <string>
#include <utility>

namespace fettle::merge {

/// A scan as registration sees it, in its own frame.
struct Scan {
    /// @param xyz_  3xN, mm, finite   @param length  of the cubes of the means, mm
    /// @throws InputError as VoxelGrid
    Scan(std::string name_, Eigen::Matrix3Xd xyz_, const Sides& sides, double length)
        : name(std::move(name_)), xyz(std::move(xyz_)), grid(xyz, length), means(voxel_means(xyz, grid, sides, length)),
          index(means.xyz), frame(align::twist_frame(means.xyz))
    {
    }

    std::string name;     ///< for messages
    Eigen::Matrix3Xd xyz; ///< mm
    VoxelGrid grid;       ///< of the points
    VoxelMeans means;
    geometry::PointIndex<3> index; ///< of the means
    align::TwistFrame frame;       ///< at the centroid of the means, with their radius

    /// Standard deviation of a mean along its normal, mm.
    double sd(Eigen::Index mean) const { return means.noise / std::sqrt(means.counts[mean]); }
};

} // namespace fettle::merge
