#include "machining/straight_way.h"

#include <algorithm>

namespace fettle {
namespace {

/// Points that are thinned at a time; straight moves pass no more.
constexpr std::size_t kMostThinned = 1000;

bool straight(std::span<const Eigen::Vector3d> tips)
{
    const Eigen::Vector3d way = tips.back() - tips.front();
    const double length = way.norm();
    return std::all_of(tips.begin(), tips.end(), [&](const Eigen::Vector3d& tip) {
        const Eigen::Vector3d off = tip - tips.front();
        const double share = length > 0 ? std::clamp(off.dot(way) / (length * length), 0.0, 1.0) : 0;
        return (off - share * way).norm() <= kThinning;
    });
}

} // namespace

std::size_t straight_to(std::span<const Eigen::Vector3d> tips)
{
    const std::size_t last = std::min(tips.size() - 1, kMostThinned);
    if (last == 0) return 0;
    // doubling, then halving: few looks at long straight ways
    std::size_t to = 1, step = 1;
    const auto goes = [&] { return to + step <= last && straight(tips.first(to + step + 1)); };
    for (; goes(); step *= 2) to += step;
    for (; step > 0; step /= 2)
        if (goes()) to += step;
    return to;
}

} // namespace fettle
