#pragma once

#include <Eigen/Core>

#include <functional>
#include <span>

namespace fettle::clean {

/// Squared distances of a point to its nearest others, ascending, mm², in float as PCL's k-d tree has them.
/// @param i  column of the point
using UseNeighbours = std::function<void(Eigen::Index i, std::span<const float> squared)>;

/// Calls `use` once for each point, in parallel, with its `count` nearest others. All neighbourhoods are searched
/// together: a k-d tree has buckets of points as its leaves, is descended once for all points of a bucket (Gray & Moore
/// 2001, all nearest neighbours), and the distances to a bucket's points are computed at once. That takes 0.4 of the
/// processor time of pcl::KdTreeFLANN, one point after the other (tests/bench/libraries_bench.cc), with the same
/// distances.
/// @param xyz  3xN, mm, finite; N > count
void for_each_neighbourhood(const Eigen::Matrix3Xd& xyz, int count, const UseNeighbours& use);

} // namespace fettle::clean
