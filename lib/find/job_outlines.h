#pragma once

#include "find/find.h"
#include "find/height_map.h"

#include <functional>

namespace fettle::find {

/// The point of a polygon's edge nearest to a point.
Eigen::Vector2d nearest_on(const Eigen::Matrix2Xd& polygon, const Eigen::Vector2d& point);

/// B without the pieces beyond an edge of the part or of the scan, where there is nothing to grind; B itself if there
/// are none. Holes of the part inside of B remain in it.
/// @param map  of the part, in the anomaly's frame   @param part  its cells that are seen and not beyond an edge
Eigen::Matrix2Xd clipped_to_part(const Eigen::Matrix2Xd& boundary, const HeightMap& map, const Mask& part);

/// B with at least `count` corners on metal (job::corners_on_metal), by corners added along its sides; fewer if they
/// would be closer than `min_spacing`, mm. The shape remains.
Eigen::Matrix2Xd with_more_corners(const Eigen::Matrix2Xd& boundary, const Eigen::Matrix2Xd& sampling, double count,
                                   double min_spacing);

/// S with each corner moved towards B until no edge, fillet or hole lies between. Where the part ends at B, so does S.
/// @param map, part  as for clipped_to_part()
/// @param is_good  whether the part lies on the continued surface around B at a place
Eigen::Matrix2Xd sampling_before_edges(const FoundAnomaly& anomaly, const HeightMap& map, const Mask& part,
                                       const std::function<bool(const Eigen::Vector2d&)>& is_good);

} // namespace fettle::find
