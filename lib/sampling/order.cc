#include "sampling/order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fettle {

namespace {

using Order = std::vector<Eigen::Index>;

// A way is better only if it is shorter by this share: equal ways, which regular layouts have many of, are then told
// apart by the touches' numbers, not by rounding.
constexpr double kShorter = 1 - 1e-9;

// A free-form layout has 16 touches; more starts than this would cost time and gain little.
constexpr Eigen::Index kMostStarts = 64;

double distance(const Eigen::Matrix2Xd& xy, Eigen::Index a, Eigen::Index b) { return (xy.col(a) - xy.col(b)).norm(); }

Order nearest_neighbours(const Eigen::Matrix2Xd& xy, Eigen::Index start)
{
    Order order = {start};
    std::vector<bool> visited(static_cast<std::size_t>(xy.cols()), false);
    visited[static_cast<std::size_t>(start)] = true;
    while (order.size() < visited.size()) {
        Eigen::Index nearest = -1;
        double least = std::numeric_limits<double>::infinity();
        for (Eigen::Index i = 0; i < xy.cols(); ++i) {
            const double d = distance(xy, order.back(), i);
            if (!visited[static_cast<std::size_t>(i)] && (nearest < 0 || d < least * kShorter)) nearest = i, least = d;
        }
        visited[static_cast<std::size_t>(nearest)] = true;
        order.push_back(nearest);
    }
    return order;
}

// Reverses stretches of the way, also at its ends, as long as that makes it shorter.
void two_opt(const Eigen::Matrix2Xd& xy, Order& order)
{
    const double total = way_length(xy, order);
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
                if (after >= before - (1 - kShorter) * total) continue;
                std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                             order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
                improved = true;
            }
    }
}

} // namespace

double way_length(const Eigen::Matrix2Xd& xy, const Order& order)
{
    double length = 0;
    for (std::size_t i = 1; i < order.size(); ++i) length += distance(xy, order[i - 1], order[i]);
    return length;
}

Order short_way(const Eigen::Matrix2Xd& xy)
{
    const Eigen::Index step = 1 + xy.cols() / kMostStarts;
    Order best;
    for (Eigen::Index start = 0; start < xy.cols(); start += step) {
        Order order = nearest_neighbours(xy, start);
        two_opt(xy, order);
        if (best.empty() || way_length(xy, order) < way_length(xy, best) * kShorter) best = order;
    }
    return best;
}

double probing_time(const Eigen::Matrix3Xd& touches, const Order& order, double safe_height,
                    const ProbingMachine& machine)
{
    double highest = -std::numeric_limits<double>::infinity();
    for (const double z : touches.row(2)) highest = std::fmax(highest, z); // fmax passes NaN over
    if (!std::isfinite(highest)) highest = 0;
    const double approach_from = std::min(highest + machine.clearance, safe_height);

    double time = way_length(touches.topRows<2>(), order) / machine.travel;
    for (const Eigen::Index i : order) {
        const double z = std::isnan(touches(2, i)) ? highest : touches(2, i);
        const double searched = std::max(approach_from - z, 0.0);
        const double travelled = std::max(safe_height - approach_from, 0.0) + std::max(safe_height - z, 0.0);
        time += searched / machine.approach + travelled / machine.travel + machine.settle;
    }
    return time;
}

} // namespace fettle
