#include "belt/surfel_index.h"

#include <algorithm>
#include <compare>

namespace fettle::belt {

using Eigen::Index;

/// Columns 2³² cells apart share a key.
std::uint64_t SurfelIndex::column_key(const Cell& cell)
{
    return static_cast<std::uint64_t>(cell.x()) << 32 | (static_cast<std::uint64_t>(cell.y()) & 0xffffffffu);
}

SurfelIndex::SurfelIndex(const Surfels& surfels, double side) : side_(side)
{
    struct Placed {
        std::uint64_t column;
        std::int64_t z;
        Index surfel;
        auto operator<=>(const Placed&) const = default;
    };
    std::vector<Placed> placed;
    for (Index i = 0; i < surfels.size(); ++i) {
        if (!surfels.position.col(i).allFinite()) continue;
        const Cell cell = cell_of(surfels.position.col(i));
        placed.push_back({column_key(cell), cell.z(), i});
    }
    std::sort(placed.begin(), placed.end());
    order_.reserve(placed.size());
    for (std::size_t k = 0; k < placed.size(); ++k) {
        const bool is_new_column = k == 0 || placed[k].column != placed[k - 1].column;
        if (is_new_column || placed[k].z != placed[k - 1].z) cells_.push_back({placed[k].z, k, k});
        if (is_new_column) columns_[placed[k].column].first = cells_.size() - 1;
        columns_[placed[k].column].second = cells_.size();
        cells_.back().end = k + 1;
        order_.push_back(placed[k].surfel);
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
        for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y()) {
            const auto column = columns_.find(column_key(cell));
            if (column == columns_.end()) continue;
            for (std::size_t k = column->second.first; k < column->second.second; ++k) {
                cell.z() = cells_[k].z;
                if (cell.z() < first.z() || cell.z() > last.z()) continue;
                const Eigen::Vector3d p = (cell.cast<double>().array() + 0.5) * side_;
                if (((R_frame_part * (p - center)).cwiseAbs().array() > max_distance.array()).any()) continue;
                result.insert(result.end(), order_.begin() + cells_[k].begin, order_.begin() + cells_[k].end);
            }
        }
}

} // namespace fettle::belt
