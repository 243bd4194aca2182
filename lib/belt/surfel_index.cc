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

void SurfelIndex::near(const Eigen::Vector3d& place, double reach, std::vector<Index>& result) const
{
    result.clear();
    const Cube first = cube_of(place.array() - reach), last = cube_of(place.array() + reach);
    Cube cube;
    for (cube.x() = first.x(); cube.x() <= last.x(); ++cube.x())
        for (cube.y() = first.y(); cube.y() <= last.y(); ++cube.y())
            for (cube.z() = first.z(); cube.z() <= last.z(); ++cube.z()) {
                const auto found = range_.find(key(cube));
                if (found == range_.end()) continue;
                result.insert(result.end(), order_.begin() + static_cast<std::ptrdiff_t>(found->second.first),
                              order_.begin() + static_cast<std::ptrdiff_t>(found->second.second));
            }
}

} // namespace fettle
