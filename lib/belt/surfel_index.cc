#include "belt/surfel_index.h"

#include <algorithm>

namespace fettle::belt {

using Eigen::Index;

/// Cells 2²¹ apart share a key, which for cells of 1 mm is 2 km.
std::uint64_t SurfelIndex::key(const Cell& cell)
{
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(cell.x()) & kMask) << 42 | (static_cast<std::uint64_t>(cell.y()) & kMask) << 21 |
           (static_cast<std::uint64_t>(cell.z()) & kMask);
}

SurfelIndex::SurfelIndex(const Surfels& surfels, double side) : side_(side)
{
    std::vector<std::pair<std::uint64_t, Index>> keyed;
    for (Index i = 0; i < surfels.size(); ++i)
        if (surfels.position.col(i).allFinite()) keyed.emplace_back(key(cell_of(surfels.position.col(i))), i);
    std::sort(keyed.begin(), keyed.end());
    for (std::size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
        while (end < keyed.size() && keyed[end].first == keyed[begin].first) order_.push_back(keyed[end++].second);
        ranges_[keyed[begin].first] = {begin, end};
    }
}

void SurfelIndex::box_search(const Eigen::Isometry3d& T_part_frame, const Eigen::AlignedBox3d& box,
                             std::vector<Index>& result) const
{
    result.clear();
    const Eigen::Matrix3d abs_rotation = T_part_frame.linear().cwiseAbs();
    const Eigen::Vector3d center = T_part_frame * box.center(), half_extent = abs_rotation * box.sizes() / 2;
    // Max. distance of the centres of box and cell along the axes of the box if they intersect.
    const Eigen::Vector3d max_distance =
        box.sizes() / 2 + abs_rotation.transpose() * Eigen::Vector3d::Constant(side_ / 2);
    const Eigen::Matrix3d R_frame_part = T_part_frame.linear().transpose();
    const Cell first = cell_of(center - half_extent), last = cell_of(center + half_extent);
    Cell cell;
    for (cell.x() = first.x(); cell.x() <= last.x(); ++cell.x())
        for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y())
            for (cell.z() = first.z(); cell.z() <= last.z(); ++cell.z()) {
                const Eigen::Vector3d p = (cell.cast<double>().array() + 0.5) * side_;
                if (((R_frame_part * (p - center)).cwiseAbs().array() > max_distance.array()).any()) continue;
                const auto found = ranges_.find(key(cell));
                if (found == ranges_.end()) continue;
                const auto [begin, end] = found->second;
                result.insert(result.end(), order_.begin() + begin, order_.begin() + end);
            }
}

} // namespace fettle::belt
