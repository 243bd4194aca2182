#pragma once

#include <Eigen/Geometry>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>

namespace fettle::core {

/// Axis-aligned box around many things, by all processors.
/// @param extend  extend(box, i) extends a box by thing i, 0 to count - 1
template <typename Extend>
Eigen::AlignedBox3d parallel_bounding_box(std::size_t count, const Extend& extend)
{
    const auto extend_all = [&](const tbb::blocked_range<std::size_t>& range, Eigen::AlignedBox3d box) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) extend(box, i);
        return box;
    };
    const auto merge = [](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.merged(b); };
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, count), Eigen::AlignedBox3d(), extend_all, merge);
}

} // namespace fettle::core
