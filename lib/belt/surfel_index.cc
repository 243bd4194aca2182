#include "belt/surfel_index.h"

#include <algorithm>
#include <numeric>

namespace fettle {

using Eigen::Index;

/// Cubes that are 2²¹ apart share a key: at 1 mm two kilometres.
std::uint64_t SurfelIndex::key(const Cube& cube)
{
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(cube.x()) & kMask) << 42 | (static_cast<std::uint64_t>(cube.y()) & kMask) << 21 |
           (static_cast<std::uint64_t>(cube.z()) & kMask);
}

SurfelIndex::SurfelIndex(const Surfels& surfels, double side) : side_(side)
{
    std::vector<std::pair<std::uint64_t, Index>> keyed;
    for (Index i = 0; i < surfels.size(); ++i)
        if (surfels.position.col(i).allFinite()) keyed.emplace_back(key(cube_of(surfels.position.col(i))), i);
    std::sort(keyed.begin(), keyed.end());
    for (std::size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
        while (end < keyed.size() && keyed[end].first == keyed[begin].first) order_.push_back(keyed[end++].second);
        range_[keyed[begin].first] = {begin, end};
    }
}

void SurfelIndex::in_box(const Eigen::Isometry3d& T_part_frame, const Eigen::AlignedBox3d& box,
                         std::vector<Index>& result) const
{
    result.clear();
    const Eigen::Matrix3d turned = T_part_frame.linear().cwiseAbs();
    const Eigen::Vector3d middle = T_part_frame * box.center(), around = turned * box.sizes() / 2;
    // A cube's middle is no farther from the box's than this where they meet: seen along the box's sides.
    const Eigen::Vector3d most = box.sizes() / 2 + turned.transpose() * Eigen::Vector3d::Constant(side_ / 2);
    const Eigen::Matrix3d to_frame = T_part_frame.linear().transpose();
    const Cube first = cube_of(middle - around), last = cube_of(middle + around);
    Cube cube;
    for (cube.x() = first.x(); cube.x() <= last.x(); ++cube.x())
        for (cube.y() = first.y(); cube.y() <= last.y(); ++cube.y())
            for (cube.z() = first.z(); cube.z() <= last.z(); ++cube.z()) {
                const Eigen::Vector3d at = (cube.cast<double>().array() + 0.5) * side_;
                if (((to_frame * (at - middle)).cwiseAbs().array() > most.array()).any()) continue;
                const auto found = range_.find(key(cube));
                if (found == range_.end()) continue;
                result.insert(result.end(), order_.begin() + static_cast<std::ptrdiff_t>(found->second.first),
                              order_.begin() + static_cast<std::ptrdiff_t>(found->second.second));
            }
}

} // namespace fettle
