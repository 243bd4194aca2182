#pragma once

#include "find/find.h"
#include "find/height_map.h"

#include <functional>

namespace fettle::find {

/// The point of a polygon's edge that is nearest to another.
Eigen::Vector2d nearest_on(const Eigen::Matrix2Xd& polygon, const Eigen::Vector2d& point);

/// B without what juts out over an edge of the part or of the scan, where there is nothing to grind; B itself if that
/// is none of it. Holes that lie inside of it stay.
/// @param map  of the part, in the anomaly's frame   @param part  its cells that are seen and not beyond an edge
Eigen::Matrix2Xd clipped_to_part(const Eigen::Matrix2Xd& boundary, const HeightMap& map, const Mask& part);

/// B with as many corners on metal (job::corners_on_metal) as asked for, further ones along its sides; fewer if they
/// would come nearer to each other than a spacing. Its shape stays.
Eigen::Matrix2Xd with_more_corners(const Eigen::Matrix2Xd& boundary, const Eigen::Matrix2Xd& sampling, double count,
                                   double min_spacing);

/// S, each corner drawn towards B until no edge, fillet or hole lies between. Where the part ends at B, so does S.
/// @param map, part  as for clipped_to_part()
/// @param is_good  whether the part goes on at a place as the surface around B does
Eigen::Matrix2Xd sampling_before_edges(const FoundAnomaly& anomaly, const HeightMap& map, const Mask& part,
                                       const std::function<bool(const Eigen::Vector2d&)>& is_good);

} // namespace fettle::find
