#pragma once

// A move as the rows of a height field see it. Only for milling.

#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "removal/height_field.h"

#include <Eigen/Core>

#include <utility>

namespace fettle {

/// x over y of a straight line, mm.
struct Line {
    double x = 0, slope = 0;
    double at(double y) const { return x + slope * y; }
};

/// The part of a move that some run of cells may be lowered by.
struct Sweep {
    Cutter cutter;
    Eigen::Vector3d from, to;
    Eigen::Vector2d way;        ///< unit, level
    double length = 0;          ///< level, mm; 0 for a plunge
    double z = 0, slope = 0;    ///< of the tip: z + slope · way covered
    double least = 0, most = 0; ///< cells less or more along the way than these (mm) are lowered by other moves
    double turn = 0;            ///< of an arc, rad, counter-clockwise; 0: straight
    Eigen::Vector2d centre;     ///< of an arc
    double radius = 0;          ///< of an arc
    Eigen::Array2d low, high;   ///< box of the cells, mm
    /// Sides of the rectangle that the cells of a straight move lie in, where they are left or right of it.
    Line low_sides[2], high_sides[2];
};

/// @param starts  has nothing been cut before from where the move begins?
/// @param next    the move that goes on from where this one ends, in the same run; nothing: this one is the last
Sweep sweep_of(const Cutter& cutter, const CutterMove& move, bool starts, const CutterMove* next);

/// Least and greatest x over the row at y that a sweep can touch, mm; empty unless first < second.
inline std::pair<double, double> span(const Sweep& sweep, double y)
{
    const auto greater = [](double a, double b) { return a > b ? a : b; };
    const auto less = [](double a, double b) { return a < b ? a : b; };
    return {greater(sweep.low.x(), greater(sweep.low_sides[0].at(y), sweep.low_sides[1].at(y))),
            less(sweep.high.x(), less(sweep.high_sides[0].at(y), sweep.high_sides[1].at(y)))};
}

/// What became of some cells.
struct Lowered {
    double height = 0; ///< sum over the cells, mm
    double depth = 0;  ///< greatest, mm
};

/// Lowers the cells of rows first up to end under the cutter.
/// @param floor  no cell is lowered below it
Lowered lower(HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end, double floor);

/// What stands above the sweep of a flat cutter; nothing is cut.
Lowered over_disc(const HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end);

} // namespace fettle
