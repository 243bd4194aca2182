#pragma once

// The region of a height field that one move cuts. Only for milling.

#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "removal/height_field.h"

#include <Eigen/Core>

#include <utility>

namespace fettle::machining {

/// A straight line as x over y, mm.
struct BorderLine {
    double x = 0, slope = 0;
    double at(double y) const { return x + slope * y; }
};

/// The sweep of a cutter along one move, and the cells that it may lower.
struct Sweep {
    Cutter cutter;
    Eigen::Vector3d from, to;                     ///< of the tip, mm
    Eigen::Vector2d direction;                    ///< horizontal, unit
    double length = 0;                            ///< horizontal, mm; 0 for a plunge
    double z = 0, slope = 0;                      ///< height of the tip: z + slope · horizontal distance travelled
    double min_along = 0, max_along = 0;          ///< cells outside this range along the move belong to other moves, mm
    double arc_angle = 0;                         ///< of an arc, rad, counter-clockwise; 0: straight
    Eigen::Vector2d centre;                       ///< of an arc, mm
    double radius = 0;                            ///< of an arc, mm
    Eigen::Array2d box_min, box_max;              ///< bounding box of the cells, mm
    BorderLine left_borders[2], right_borders[2]; ///< of the rectangle that contains the cells of a straight move
};

/// @param first  whether this move begins a run: no move before it has cut the cells at its start
/// @param next   the following move of the same run; nullptr: this one is the last
Sweep make_sweep(const Cutter& cutter, const CutterMove& move, bool first, const CutterMove* next);

/// Range of x in the row at y that a sweep can touch, mm; empty unless first < second.
inline std::pair<double, double> x_range(const Sweep& sweep, double y)
{
    const auto greater = [](double a, double b) { return a > b ? a : b; };
    const auto less = [](double a, double b) { return a < b ? a : b; };
    return {greater(sweep.box_min.x(), greater(sweep.left_borders[0].at(y), sweep.left_borders[1].at(y))),
            less(sweep.box_max.x(), less(sweep.right_borders[0].at(y), sweep.right_borders[1].at(y)))};
}

/// Heights removed from some cells.
struct RemovedHeight {
    double height = 0; ///< sum over the cells, mm
    double depth = 0;  ///< largest, mm
};

/// Lowers the cells of the rows [first, end) under the cutter.
/// @param floor  no cell is lowered below it, mm
RemovedHeight cut_rows(removal::HeightField& field, const Sweep& sweep, Eigen::Index first, Eigen::Index end,
                       double floor);

/// Heights of the material above the sweep of a flat cutter, without cutting it.
RemovedHeight height_above_disc(const removal::HeightField& field, const Sweep& sweep, Eigen::Index first,
                                Eigen::Index end);

} // namespace fettle::machining
