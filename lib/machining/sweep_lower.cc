#include "core/constants.h"
#include "core/simd.h"
#include "machining/cutter_side.h"
#include "machining/sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace fettle::machining {
namespace {

/// Lowest height of the cutter's lower side over four cells during a straight move.
/// @param level  the slope is 0
template <typename Side, bool level>
struct Straight {
    static constexpr bool is_arc = false;
    const Sweep& sweep;
    const Side& side;
    FETTLE_INLINE Double4 height(const Double4& x, double y) const
    {
        const Double4 dx = x - sweep.from.x();
        const double dy = y - sweep.from.y();
        const Double4 along = sweep.direction.x() * dx + sweep.direction.y() * dy;
        const Double4 across = sweep.direction.x() * dy - sweep.direction.y() * dx;
        Double4 axis = along;
        if constexpr (std::is_same_v<Side, BullSide> && !level)
            axis = side.clamped_axis(along, across, sweep.length);
        else {
            if constexpr (!level) axis += side.lead(across);
            axis = cwise_min(cwise_max(axis, Double4{}), broadcast(sweep.length));
        }
        const Double4 before = along - axis;
        const Double4 rise = side.rise(before * before + across * across);
        if constexpr (level)
            return sweep.z + rise;
        else
            return sweep.z + sweep.slope * axis + rise;
    }
};

/// Lowest height during a horizontal arc; outside its sector the nearer end is the closest position.
template <typename Side>
struct Arc {
    static constexpr bool is_arc = true;
    const Sweep& sweep;
    const Side& side;
    FETTLE_INLINE Double4 height(const Double4& x, double y) const
    {
        const Double4 dx = x - sweep.centre.x();
        const double dy = y - sweep.centre.y();
        const Eigen::Vector2d a = sweep.from.head<2>() - sweep.centre, b = sweep.to.head<2>() - sweep.centre;
        const double turn = sweep.arc_angle;
        const Mask4 after_start = turn * (a.x() * dy - a.y() * dx) >= 0.0;
        const Mask4 before_end = turn * (dx * b.y() - dy * b.x()) >= 0.0;
        Mask4 in_sector = after_start & before_end;
        if (std::abs(turn) > std::numbers::pi) in_sector = after_start | before_end;
        if (std::abs(turn) >= 2 * std::numbers::pi) in_sector = ~Mask4{};
        const Double4 radial = cwise_sqrt(dx * dx + dy * dy) - sweep.radius;
        const Double4 ax = dx - a.x(), bx = dx - b.x();
        const double ay = dy - a.y(), by = dy - b.y();
        const Double4 ends = cwise_min(ax * ax + ay * ay, bx * bx + by * by);
        return sweep.z + side.rise(in_sector ? radial * radial : ends);
    }
};

FETTLE_INLINE void cut_four(Double4& cells, const Double4& height, double floor, Double4& sum, Double4& max)
{
    const Double4 to = height < floor ? broadcast(floor) : height; // NaN stays NaN
    const Mask4 lowered = cells > to;                              // false for NaN: no material
    const Double4 depth = reinterpret_cast<Double4>(reinterpret_cast<Mask4>(cells - to) & lowered);
    sum += depth;
    max = cwise_max(depth, max);
    cells = lowered ? to : cells;
}

/// A row of cells, and the heights removed so far.
/// @param Cell  double; with const double the removal is computed but not done
template <typename Cell>
struct Row {
    Cell* z;
    double x0, cell, per_mm; ///< left border of the first cell, width of a cell, 1 / width
    Eigen::Index columns;
    double y = 0, floor = 0;
    Double4 sum{}, max{};

    /// Lowers the cells whose centres are in [from, to]. A group of four may include cells outside the range; for these
    /// the height is valid, too.
    template <typename Shape>
    FETTLE_INLINE void cut(const Shape& shape, double from, double to)
    {
        const double first = (from - x0) * per_mm - 0.5, end = (to - x0) * per_mm + 0.5;
        const double limit = columns;
        if (!(first < limit && end > 0 && from < to)) return;
        const auto last = static_cast<Eigen::Index>(end < limit ? end : limit);
        for (auto i = static_cast<Eigen::Index>(first > 0 ? first : 0); i < last; i += kLanes) {
            const Double4 x = x0 + cell * (static_cast<double>(i) + Double4{0.5, 1.5, 2.5, 3.5});
            const Double4 height = shape.height(x, y);
            const Eigen::Index count = columns - i < kLanes ? columns - i : kLanes;
            Double4 cells = broadcast(core::kNaN);
            if (count == kLanes)
                cells = *reinterpret_cast<const Double4*>(z + i);
            else
                for (Eigen::Index k = 0; k < count; ++k) cells[k] = z[i + k];
            cut_four(cells, height, floor, sum, max);
            if constexpr (!std::is_const_v<Cell>) {
                if (count == kLanes)
                    *reinterpret_cast<Double4*>(z + i) = cells;
                else
                    for (Eigen::Index k = 0; k < count; ++k) z[i + k] = cells[k];
            }
        }
    }
};

template <typename Cell, typename Shape>
FETTLE_INLINE RemovedHeight cut_shape(const removal::HeightField& field, Cell* z, const Sweep& sweep,
                                      const Shape& shape, Eigen::Index first, Eigen::Index end, double floor)
{
    Row<Cell> row{z, field.origin.x(), field.cell, 1 / field.cell, field.columns()};
    row.floor = floor;
    for (Eigen::Index j = first; j < end; ++j) {
        row.z = z + j * row.columns;
        row.y = field.origin.y() + row.cell * (static_cast<double>(j) + 0.5);
        const auto [from, to] = x_range(sweep, row.y);
        if constexpr (Shape::is_arc) { // skip the inside of the ring
            const double inner = sweep.radius - sweep.cutter.radius - kRimTolerance, dy = row.y - sweep.centre.y();
            if (inner > std::abs(dy)) {
                const double half = std::sqrt((inner - dy) * (inner + dy)), x = sweep.centre.x();
                row.cut(shape, from, to < x - half ? to : x - half);
                row.cut(shape, from > x + half ? from : x + half, to);
                continue;
            }
        }
        row.cut(shape, from, to);
    }
    const Double4& sum = row.sum;
    const Double4& max = row.max;
    return {(sum[0] + sum[1]) + (sum[2] + sum[3]), std::max({max[0], max[1], max[2], max[3]})};
}

template <typename Side, typename Cell>
FETTLE_INLINE RemovedHeight cut_under(const removal::HeightField& field, Cell* z, const Sweep& sweep,
                                      Eigen::Index first, Eigen::Index end, double floor)
{
    const Side side(sweep.cutter, sweep.slope);
    if (sweep.arc_angle != 0) return cut_shape(field, z, sweep, Arc<Side>{sweep, side}, first, end, floor);
    if (sweep.slope == 0) return cut_shape(field, z, sweep, Straight<Side, true>{sweep, side}, first, end, floor);
    return cut_shape(field, z, sweep, Straight<Side, false>{sweep, side}, first, end, floor);
}

FETTLE_CLONES RemovedHeight lower_under(const removal::HeightField& field, double* z, const Sweep& sweep,
                                        Eigen::Index first, Eigen::Index end, double floor)
{
    const Cutter& c = sweep.cutter;
    if (c.cone_from < c.radius) return cut_under<TaperSide>(field, z, sweep, first, end, floor);
    if (c.corner == 0) return cut_under<FlatSide>(field, z, sweep, first, end, floor);
    if (c.flat == 0) return cut_under<BallSide>(field, z, sweep, first, end, floor);
    return cut_under<BullSide>(field, z, sweep, first, end, floor);
}
FETTLE_CLONES RemovedHeight above_flat(const removal::HeightField& field, const Sweep& sweep, Eigen::Index first,
                                       Eigen::Index end)
{
    return cut_under<FlatSide>(field, field.z.data(), sweep, first, end, -core::kInfinity);
}

} // namespace

RemovedHeight cut_rows(removal::HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end,
                       double floor)
{
    return lower_under(field, field.z.data(), sweep, first, end, floor);
}

RemovedHeight height_above_disc(const removal::HeightField& field, const Sweep& sweep, Eigen::Index first,
                                Eigen::Index end)
{
    return above_flat(field, sweep, first, end);
}

} // namespace fettle::machining
