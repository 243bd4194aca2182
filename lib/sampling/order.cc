#include "sampling/order.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>

namespace fettle::sampling {

namespace {

using Order = std::vector<Eigen::Index>;

// A path is shorter only if its length is less than this factor times the other's: ties, which are common in regular
// layouts, are then decided by the indices of the touches, not by rounding.
constexpr double kShorterFactor = 1 - 1e-9;

// A free-form layout has 16 touches; more starts than this would cost time and gain little.
constexpr Eigen::Index kMaxStarts = 64;

double distance(const Eigen::Matrix2Xd& xy, Eigen::Index a, Eigen::Index b) { return (xy.col(a) - xy.col(b)).norm(); }

Order nearest_neighbour_path(const Eigen::Matrix2Xd& xy, Eigen::Index start)
{
    Order order = {start};
    std::vector<bool> visited(xy.cols(), false);
    visited[start] = true;
    while (order.size() < visited.size()) {
        Eigen::Index nearest = -1;
        double min_distance = core::kInfinity;
        for (Eigen::Index i = 0; i < xy.cols(); ++i) {
            const double d = distance(xy, order.back(), i);
            if (!visited[i] && (nearest < 0 || d < min_distance * kShorterFactor)) nearest = i, min_distance = d;
        }
        visited[nearest] = true;
        order.push_back(nearest);
    }
    return order;
}

// 2-opt: reverses sections of the path, also at its ends, while that makes it shorter.
void two_opt(const Eigen::Matrix2Xd& xy, Order& order)
{
    const double total = probing_path_length(xy, order);
    const std::size_t n = order.size();
    for (bool improved = true; improved;) {
        improved = false;
        for (std::size_t i = 0; i + 1 < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j) {
                double before = 0, after = 0;
                if (i > 0)
                    before += distance(xy, order[i - 1], order[i]), after += distance(xy, order[i - 1], order[j]);
                if (j + 1 < n)
                    before += distance(xy, order[j], order[j + 1]), after += distance(xy, order[i], order[j + 1]);
                if (after >= before - (1 - kShorterFactor) * total) continue;
                std::reverse(order.begin() + i, order.begin() + j + 1);
                improved = true;
            }
    }
}

} // namespace

double probing_path_length(const Eigen::Matrix2Xd& xy, const Order& order)
{
    double length = 0;
    for (std::size_t i = 1; i < order.size(); ++i) length += distance(xy, order[i - 1], order[i]);
    return length;
}

Order short_probing_path(const Eigen::Matrix2Xd& xy)
{
    const Eigen::Index step = 1 + xy.cols() / kMaxStarts;
    Order best;
    for (Eigen::Index start = 0; start < xy.cols(); start += step) {
        Order order = nearest_neighbour_path(xy, start);
        two_opt(xy, order);
        if (best.empty() || probing_path_length(xy, order) < probing_path_length(xy, best) * kShorterFactor)
            best = order;
    }
    return best;
}

double probing_time(const Eigen::Matrix3Xd& touches, const Order& order, double safe_height,
                    const ProbingMachine& machine)
{
    double highest = -core::kInfinity;
    for (const double z : touches.row(2)) highest = std::fmax(highest, z); // fmax ignores NaN
    if (!std::isfinite(highest)) highest = 0;
    const double approach_from = std::min(highest + machine.approach_clearance, safe_height);

    double time = probing_path_length(touches.topRows<2>(), order) / machine.travel_speed;
    for (const Eigen::Index i : order) {
        const double z = std::isnan(touches(2, i)) ? highest : touches(2, i);
        const double searched = std::max(approach_from - z, 0.0);
        const double travelled = std::max(safe_height - approach_from, 0.0) + std::max(safe_height - z, 0.0);
        time += searched / machine.approach_speed + travelled / machine.travel_speed + machine.dwell;
    }
    return time;
}

} // namespace fettle::sampling
