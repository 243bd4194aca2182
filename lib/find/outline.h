#pragma once

#include "find/height_map.h"

#include <Eigen/Core>

namespace fettle::find {

/// The polygons of an anomaly, in cells of the map: (0, 0) is the centre of the first.
struct Outlines {
    Eigen::Matrix2Xd boundary; ///< B: the region without holes, grown to where the surface begins
    Eigen::Matrix2Xd sampling; ///< S: a ring around B as far as the metal is good
    Mask inside;               ///< cells of B, of the map's size
};

/// Boundaries of a region. S reaches 0.6 of the region's thickness from B, in straight lines from B, up to edges of
/// what is seen, creases, and other regions.
/// @param region   of the map's size   @param others  cells of other anomalies
/// @param growth   shells around it, a cell each, that are still above the surface: B encloses them, too
Outlines outlines_of(const HeightMap& map, const Mask& region, const Mask& others, int growth);

} // namespace fettle::find
