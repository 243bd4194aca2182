#include "core/simd.h"
#include "machining/cutter_side.h"
#include "machining/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace fettle {
namespace {

/// Height of the lower side of a straight move over cells dx, dy from its beginning.
template <typename Side, bool level>
struct Straight {
    static constexpr bool round = false;
    const Sweep& sweep;
    const Side& side;
    FETTLE_INLINE Double4 height(const Double4& x, double y) const
    {
        const Double4 dx = x - sweep.from.x();
        const double dy = y - sweep.from.y();
        const Double4 along = sweep.way.x() * dx + sweep.way.y() * dy;
        const Double4 across = sweep.way.x() * dy - sweep.way.y() * dx;
        Double4 axis = along;
        if constexpr (std::is_same_v<Side, BullSide> && !level)
            axis = side.axis(along, across, sweep.length);
        else {
            if constexpr (!level) axis += side.lead(across);
            axis = smaller(larger(axis, Double4{}), all(sweep.length));
        }
        const Double4 before = along - axis;
        const Double4 rise = side.rise(before * before + across * across);
        if constexpr (level)
            return sweep.z + rise;
        else
            return sweep.z + sweep.slope * axis + rise;
    }
};

/// The same of a level arc: beside its angle the nearer end counts.
template <typename Side>
struct Arc {
    static constexpr bool round = true;
    const Sweep& sweep;
    const Side& side;
    FETTLE_INLINE Double4 height(const Double4& x, double y) const
    {
        const Double4 dx = x - sweep.centre.x();
        const double dy = y - sweep.centre.y();
        const Eigen::Vector2d a = sweep.from.head<2>() - sweep.centre, b = sweep.to.head<2>() - sweep.centre;
        const double turn = sweep.turn;
        const Mask4 after_start = turn * (a.x() * dy - a.y() * dx) >= 0.0;
        const Mask4 before_end = turn * (dx * b.y() - dy * b.x()) >= 0.0;
        Mask4 beside = after_start & before_end;
        if (std::abs(turn) > std::numbers::pi) beside = after_start | before_end;
        if (std::abs(turn) >= 2 * std::numbers::pi) beside = ~Mask4{};
        const Double4 off = root(dx * dx + dy * dy) - sweep.radius;
        const Double4 ax = dx - a.x(), bx = dx - b.x();
        const double ay = dy - a.y(), by = dy - b.y();
        const Double4 ends = smaller(ax * ax + ay * ay, bx * bx + by * by);
        return sweep.z + side.rise(beside ? off * off : ends);
    }
};

FETTLE_INLINE void lower_four(Double4& cells, const Double4& height, double floor, Double4& sum, Double4& most)
{
    const Double4 to = height < floor ? all(floor) : height; // NaN stays
    const Mask4 lowered = cells > to;                        // never where there is no material
    const Double4 depth = reinterpret_cast<Double4>(reinterpret_cast<Mask4>(cells - to) & lowered);
    sum += depth;
    most = larger(depth, most);
    cells = lowered ? to : cells;
}

/// A row of cells, and what has been cut of them.
/// @param Cell  double; const double only sees what would be done
template <typename Cell>
struct Row {
    Cell* z;
    double x0, cell, per_mm; ///< of the cells: left side of the first, width, 1 / width
    Eigen::Index columns;
    double y = 0, floor = 0;
    Double4 sum{}, most{};

    /// Lowers the cells whose centres lie from x to x, and some beside them, which lose nothing by it that they keep.
    template <typename Shape>
    FETTLE_INLINE void lower(const Shape& shape, double from, double to)
    {
        const double least = (from - x0) * per_mm - 0.5, beyond = (to - x0) * per_mm + 0.5;
        const double limit = static_cast<double>(columns);
        if (!(least < limit && beyond > 0 && from < to)) return;
        const auto last = static_cast<Eigen::Index>(beyond < limit ? beyond : limit);
        for (auto i = static_cast<Eigen::Index>(least > 0 ? least : 0); i < last; i += kLanes) {
            const Double4 x = x0 + cell * (static_cast<double>(i) + Double4{0.5, 1.5, 2.5, 3.5});
            const Double4 height = shape.height(x, y);
            const Eigen::Index count = columns - i < kLanes ? columns - i : kLanes;
            Double4 cells = all(std::numeric_limits<double>::quiet_NaN());
            if (count == kLanes)
                cells = *reinterpret_cast<const Double4*>(z + i);
            else
                for (Eigen::Index k = 0; k < count; ++k) cells[k] = z[i + k];
            lower_four(cells, height, floor, sum, most);
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
FETTLE_INLINE Lowered rows(const HeightField& field, Cell* z, const Sweep& sweep, const Shape& shape,
                           Eigen::Index first, Eigen::Index end, double floor)
{
    Row<Cell> row{z, field.origin.x(), field.cell, 1 / field.cell, field.columns()};
    row.floor = floor;
    for (Eigen::Index j = first; j < end; ++j) {
        row.z = z + j * row.columns;
        row.y = field.origin.y() + row.cell * (static_cast<double>(j) + 0.5);
        const auto [from, to] = span(sweep, row.y);
        if constexpr (Shape::round) { // what lies within the ring is passed over
            const double inner = sweep.radius - sweep.cutter.radius - kOnRim, dy = row.y - sweep.centre.y();
            if (inner > std::abs(dy)) {
                const double half = std::sqrt((inner - dy) * (inner + dy)), x = sweep.centre.x();
                row.lower(shape, from, to < x - half ? to : x - half);
                row.lower(shape, from > x + half ? from : x + half, to);
                continue;
            }
        }
        row.lower(shape, from, to);
    }
    const Double4& sum = row.sum;
    const Double4& most = row.most;
    return {(sum[0] + sum[1]) + (sum[2] + sum[3]), std::max({most[0], most[1], most[2], most[3]})};
}

template <typename Side, typename Cell>
FETTLE_INLINE Lowered rows_under(const HeightField& field, Cell* z, const Sweep& sweep, Eigen::Index first,
                                 Eigen::Index end, double floor)
{
    const Side side(sweep.cutter, sweep.slope);
    if (sweep.turn != 0) return rows(field, z, sweep, Arc<Side>{sweep, side}, first, end, floor);
    if (sweep.slope == 0) return rows(field, z, sweep, Straight<Side, true>{sweep, side}, first, end, floor);
    return rows(field, z, sweep, Straight<Side, false>{sweep, side}, first, end, floor);
}

FETTLE_CLONES Lowered under_ball(const HeightField& field, double* z, const Sweep& sweep, Eigen::Index first,
                                 Eigen::Index end, double floor)
{
    return rows_under<BallSide>(field, z, sweep, first, end, floor);
}
FETTLE_CLONES Lowered under_flat(const HeightField& field, double* z, const Sweep& sweep, Eigen::Index first,
                                 Eigen::Index end, double floor)
{
    return rows_under<FlatSide>(field, z, sweep, first, end, floor);
}
FETTLE_CLONES Lowered under_bull(const HeightField& field, double* z, const Sweep& sweep, Eigen::Index first,
                                 Eigen::Index end, double floor)
{
    return rows_under<BullSide>(field, z, sweep, first, end, floor);
}
FETTLE_CLONES Lowered under_taper(const HeightField& field, double* z, const Sweep& sweep, Eigen::Index first,
                                  Eigen::Index end, double floor)
{
    return rows_under<TaperSide>(field, z, sweep, first, end, floor);
}
FETTLE_CLONES Lowered over_flat(const HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end)
{
    return rows_under<FlatSide>(field, field.z.data(), sweep, first, end, -kBeyond);
}

} // namespace

Lowered lower(HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end, double floor)
{
    const Cutter& c = sweep.cutter;
    double* z = field.z.data();
    if (c.cone_from < c.radius) return under_taper(field, z, sweep, first, end, floor);
    if (c.corner == 0) return under_flat(field, z, sweep, first, end, floor);
    if (c.flat == 0) return under_ball(field, z, sweep, first, end, floor);
    return under_bull(field, z, sweep, first, end, floor);
}

Lowered over_disc(const HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end)
{
    return over_flat(field, sweep, first, end);
}

} // namespace fettle
