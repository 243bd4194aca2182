#include "machining/straight_way.h"

#include <algorithm>

namespace fettle::machining {
namespace {

/// Largest number of tips that one straight move replaces: it bounds the cost of a test.
constexpr std::size_t kMaxThinnedTips = 1000;

bool is_straight(std::span<const Eigen::Vector3d> tips)
{
    const Eigen::Vector3d chord = tips.back() - tips.front();
    const double length = chord.norm();
    return std::ranges::all_of(tips, [&](const Eigen::Vector3d& tip) {
        const Eigen::Vector3d d = tip - tips.front();
        const double t = length > 0 ? std::clamp(d.dot(chord) / (length * length), 0.0, 1.0) : 0;
        return (d - t * chord).norm() <= kThinningTolerance;
    });
}

} // namespace

std::size_t last_on_line(std::span<const Eigen::Vector3d> tips)
{
    const std::size_t last = std::min(tips.size() - 1, kMaxThinnedTips);
    if (last == 0) return 0;
    // Exponential, then binary search: few tests on long straight lines.
    std::size_t to = 1, step = 1;
    const auto extends = [&] { return to + step <= last && is_straight(tips.first(to + step + 1)); };
    for (; extends(); step *= 2) to += step;
    for (; step > 0; step /= 2)
        if (extends()) to += step;
    return to;
}

} // namespace fettle::machining
