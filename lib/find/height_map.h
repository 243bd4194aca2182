#pragma once

#include "find/image.h"

#include <Eigen/Core>

namespace fettle::find {

/// Heights over a regular grid in the plane of a view.
struct HeightMap {
    Image z;                ///< mm
    double cell = 1;        ///< edge of a cell, mm
    Eigen::Vector2d origin; ///< centre of cell (0, 0), mm, in the view's plane

    Mask seen;        ///< cells with a height
    double sigma = 0; ///< of the noise, mm; before clean() a lower bound of it

    /// The cell whose centre is nearest to a point of the view's plane. It may lie beside the map.
    cv::Point cell_of(const Eigen::Vector2d& point) const
    {
        const Eigen::Vector2d place = (point - origin) / cell;
        return {cvRound(place.x()), cvRound(place.y())};
    }
    /// A place in cells as a point of the view's plane, mm.
    Eigen::Vector2d point_at(double x, double y) const { return origin + cell * Eigen::Vector2d(x, y); }
};

/// The map with cells `factor` times as long, which have the means; its noise is estimated again.
HeightMap coarsened(const HeightMap& map, int factor);
/// Cells of which any is in the mask.
Mask coarsened(const Mask& mask, int factor);

/// Removes single outliers (flying points), fills holes of single cells by the median around, removes small components,
/// and sets `seen` and `sigma`.
/// @param fills  false for a mesh, whose cells without a height are its walls and holes, no lack of points
void clean(HeightMap& map, bool fills);

} // namespace fettle::find
