#include "machining/sweep.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::machining {
namespace {

/// A move with a shorter horizontal length is a plunge: its slope is rounding, mm.
constexpr double kMaxPlungeLength = 1e-9;
/// Ranges are extended by this: rounding of coordinates, mm.
constexpr double kCoordinateRounding = 1e-9;

void set_direction(Sweep& sweep)
{
    const Eigen::Vector2d horizontal = (sweep.to - sweep.from).head<2>();
    const double length = horizontal.norm();
    sweep.direction = Eigen::Vector2d::UnitX();
    sweep.z = std::min(sweep.from.z(), sweep.to.z());
    if (length < kMaxPlungeLength) return;
    sweep.direction = horizontal / length;
    sweep.length = length;
    sweep.z = sweep.from.z();
    sweep.slope = (sweep.to.z() - sweep.from.z()) / length;
}

/// Distance beyond the end of a move up to which it may lower cells. The height over a cell is a convex function of the
/// distance travelled. So the move that lowers a cell either has the minimum of that function inside (the cell is
/// `lead` before the axis), or ends while the height still falls, and rises over the cell with the next move.
double extent_beyond_end(const Sweep& sweep, const CutterMove& next)
{
    Sweep following;
    following.from = next.from;
    following.to = next.to;
    set_direction(following);
    const double R = sweep.cutter.radius;
    if (next.sweep_angle != 0 || following.length == 0) return R;
    const double behind = following.slope < 0 ? 0 : max_lead(sweep.cutter, following.slope);
    const double cosine = std::clamp(sweep.direction.dot(following.direction), -1.0, 1.0);
    if (R * cosine <= behind) return R;
    return behind * cosine + std::sqrt((1 - cosine) * (1 + cosine) * (R - behind) * (R + behind));
}

/// Sets the borders of the strip min ≤ normal · ((x, y) − from) ≤ max. A strip along x does not bound x; the box does.
void set_borders(Sweep& sweep, int pair, const Eigen::Vector2d& normal, double min, double max)
{
    constexpr double kMinNormalX = 1e-9; // a smaller one would magnify rounding errors beyond kCoordinateRounding
    sweep.left_borders[pair] = {-core::kInfinity, 0};
    sweep.right_borders[pair] = {core::kInfinity, 0};
    if (std::abs(normal.x()) < kMinNormalX) return;
    const double offset = normal.dot(sweep.from.head<2>()), slope = -normal.y() / normal.x();
    const double a = (offset + min) / normal.x(), b = (offset + max) / normal.x();
    const double rounding = kCoordinateRounding / std::abs(normal.x());
    sweep.left_borders[pair] = {std::min(a, b) - rounding, slope};
    sweep.right_borders[pair] = {std::max(a, b) + rounding, slope};
}

void set_box(Sweep& sweep)
{
    const double R = sweep.cutter.radius + kCoordinateRounding;
    const Eigen::Array2d from = sweep.from.head<2>().array(), to = sweep.to.head<2>().array();
    sweep.box_min = from.min(to) - R;
    sweep.box_max = from.max(to) + R;
    if (sweep.arc_angle != 0) {
        const Eigen::Vector2d start = sweep.from.head<2>() - sweep.centre;
        for (int quarter = 0; quarter < 4; ++quarter) { // extreme points of a circle along the axes
            const double angle = quarter * std::numbers::pi / 2;
            double turn = std::remainder(angle - std::atan2(start.y(), start.x()), 2 * std::numbers::pi);
            if (turn * sweep.arc_angle < 0) turn += std::copysign(2 * std::numbers::pi, sweep.arc_angle);
            if (std::abs(turn) > std::abs(sweep.arc_angle)) continue;
            const Eigen::Array2d extreme =
                sweep.centre.array() + sweep.radius * Eigen::Array2d(std::cos(angle), std::sin(angle));
            sweep.box_min = sweep.box_min.min(extreme - R);
            sweep.box_max = sweep.box_max.max(extreme + R);
        }
        for (int pair = 0; pair < 2; ++pair) set_borders(sweep, pair, Eigen::Vector2d::Zero(), 0, 0);
        return;
    }
    set_borders(sweep, 0, sweep.direction, sweep.min_along, sweep.max_along);
    set_borders(sweep, 1, {-sweep.direction.y(), sweep.direction.x()}, -R, R);
    const Eigen::Array2d along = sweep.direction.array(), across = Eigen::Array2d(-along.y(), along.x()).abs() * R;
    const Eigen::Array2d first = from + sweep.min_along * along, last = from + sweep.max_along * along;
    sweep.box_min = sweep.box_min.max(first.min(last) - across - kCoordinateRounding);
    sweep.box_max = sweep.box_max.min(first.max(last) + across + kCoordinateRounding);
}

} // namespace

Sweep make_sweep(const Cutter& cutter, const CutterMove& move, bool first, const CutterMove* next)
{
    Sweep sweep;
    sweep.cutter = cutter;
    sweep.from = move.from;
    sweep.to = move.to;
    sweep.arc_angle = move.sweep_angle;
    sweep.centre = move.centre;
    sweep.radius = (move.from.head<2>() - move.centre).norm();
    set_direction(sweep);
    const double lead = max_lead(cutter, sweep.slope), R = cutter.radius;
    const bool whole_disc = sweep.length == 0 || sweep.arc_angle != 0;
    sweep.min_along = first || whole_disc ? -R : (sweep.slope < 0 ? -lead : 0);
    sweep.max_along = sweep.length + R;
    if (next != nullptr && !whole_disc)
        sweep.max_along = sweep.length + std::max(sweep.slope > 0 ? lead : 0, extent_beyond_end(sweep, *next));
    set_box(sweep);
    return sweep;
}

} // namespace fettle::machining
