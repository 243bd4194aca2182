#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::clean {

/// How points are thinned.
struct Thinning {
    enum class Rule {
        voxel,  ///< of the points in each cube of a grid stays the one nearest to their mean
        spacing ///< a point stays, in the order of the file, unless one that stays is nearer than the length
    };
    Rule rule = Rule::voxel;
    double length = 0; ///< of the edges of the cubes, or between points, mm
};

/// Thins points. pcl::VoxelGrid returns means, which are no measured points and have no fields; pcl::UniformSampling
/// keeps the point nearest to the middle of the cube, and so the cubes' pattern.
/// @param xyz  3xN, mm, finite   @return  1 for each point that stays, else 0
/// @throws InputError if the points extend over more than 2^20 lengths
std::vector<char> thin(const Eigen::Matrix3Xd& xyz, const Thinning& thinning);

/// Finds points that lie exactly where an earlier one lies. @param xyz  3xN, finite   @return  1 for each of them
std::vector<char> find_duplicates(const Eigen::Matrix3Xd& xyz);

} // namespace fettle::clean
