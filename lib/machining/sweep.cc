#include "machining/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {
namespace {

/// A way shorter than this (mm) is a plunge: its slope tells nothing.
constexpr double kPlunge = 1e-9;
/// Rounding of coordinates, mm: spans are wider by this.
constexpr double kSlack = 1e-9;
constexpr double kEverything = std::numeric_limits<double>::infinity();

void set_way(Sweep& sweep)
{
    const Eigen::Vector2d along = (sweep.to - sweep.from).head<2>();
    const double length = along.norm();
    sweep.way = Eigen::Vector2d::UnitX();
    sweep.z = std::min(sweep.from.z(), sweep.to.z());
    if (length < kPlunge) return;
    sweep.way = along / length;
    sweep.length = length;
    sweep.z = sweep.from.z();
    sweep.slope = (sweep.to.z() - sweep.from.z()) / length;
}

/// The height under a straight move is a convex function of the way covered, so a cell is lowered by a move whose
/// height over it is least on the way (the cell is `lead` before the axis), or where a move that ends comes down to it
/// and the next goes up from there. How far along this move the latter can be, beyond its end.
double beyond_end(const Sweep& sweep, const CutterMove& next)
{
    Sweep following;
    following.from = next.from;
    following.to = next.to;
    set_way(following);
    const double R = sweep.cutter.radius;
    if (next.sweep != 0 || following.length == 0) return R;
    const double behind = following.slope < 0 ? 0 : greatest_lead(sweep.cutter, following.slope);
    const double cosine = std::clamp(sweep.way.dot(following.way), -1.0, 1.0);
    if (R * cosine <= behind) return R;
    return behind * cosine + std::sqrt((1 - cosine) * (1 + cosine) * (R - behind) * (R + behind));
}

/// Bounds x by least ≤ offset + along · (x, y) ≤ most. A side along x bounds no x; there the box is enough.
void set_sides(Sweep& sweep, int side, const Eigen::Vector2d& along, double least, double most)
{
    constexpr double kLevel = 1e-9; // a side so level would magnify roundings beyond the slack
    sweep.low_sides[side] = {-kEverything, 0};
    sweep.high_sides[side] = {kEverything, 0};
    if (std::abs(along.x()) < kLevel) return;
    const double offset = along.dot(sweep.from.head<2>()), slope = -along.y() / along.x();
    const double a = (offset + least) / along.x(), b = (offset + most) / along.x();
    const double slack = kSlack / std::abs(along.x());
    sweep.low_sides[side] = {std::min(a, b) - slack, slope};
    sweep.high_sides[side] = {std::max(a, b) + slack, slope};
}

void set_box(Sweep& sweep)
{
    const double R = sweep.cutter.radius + kSlack;
    const Eigen::Array2d from = sweep.from.head<2>().array(), to = sweep.to.head<2>().array();
    sweep.low = from.min(to) - R;
    sweep.high = from.max(to) + R;
    if (sweep.turn != 0) {
        const Eigen::Vector2d start = sweep.from.head<2>() - sweep.centre;
        for (int quarter = 0; quarter < 4; ++quarter) { // where an arc is farthest along an axis
            const double angle = quarter * std::numbers::pi / 2;
            double past = std::remainder(angle - std::atan2(start.y(), start.x()), 2 * std::numbers::pi);
            if (past * sweep.turn < 0) past += std::copysign(2 * std::numbers::pi, sweep.turn);
            if (std::abs(past) > std::abs(sweep.turn)) continue;
            const Eigen::Array2d place =
                sweep.centre.array() + sweep.radius * Eigen::Array2d(std::cos(angle), std::sin(angle));
            sweep.low = sweep.low.min(place - R);
            sweep.high = sweep.high.max(place + R);
        }
        for (int side = 0; side < 2; ++side) set_sides(sweep, side, Eigen::Vector2d::Zero(), 0, 0);
        return;
    }
    // The rectangle of the cells that this move lowers.
    set_sides(sweep, 0, sweep.way, sweep.least, sweep.most);
    set_sides(sweep, 1, {-sweep.way.y(), sweep.way.x()}, -R, R);
    const Eigen::Array2d along = sweep.way.array(), across = Eigen::Array2d(-along.y(), along.x()).abs() * R;
    const Eigen::Array2d first = from + sweep.least * along, last = from + sweep.most * along;
    sweep.low = sweep.low.max(first.min(last) - across - kSlack);
    sweep.high = sweep.high.min(first.max(last) + across + kSlack);
}

} // namespace

Sweep sweep_of(const Cutter& cutter, const CutterMove& move, bool starts, const CutterMove* next)
{
    Sweep sweep;
    sweep.cutter = cutter;
    sweep.from = move.from;
    sweep.to = move.to;
    sweep.turn = move.sweep;
    sweep.centre = move.centre;
    sweep.radius = (move.from.head<2>() - move.centre).norm();
    set_way(sweep);
    const double leads = greatest_lead(cutter, sweep.slope), R = cutter.radius;
    const bool whole = sweep.length == 0 || sweep.turn != 0;
    sweep.least = starts || whole ? -R : (sweep.slope < 0 ? -leads : 0);
    sweep.most = sweep.length + R;
    if (next != nullptr && !whole)
        sweep.most = sweep.length + std::max(sweep.slope > 0 ? leads : 0, beyond_end(sweep, *next));
    set_box(sweep);
    return sweep;
}

} // namespace fettle
