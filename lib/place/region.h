#pragma once

#include "align/oriented_points.h"

#include <Eigen/Core>

namespace fettle::place {

enum class RegionShape { plane, cylinder };

/// A plane or a cylinder of a part.
struct FoundRegion {
    Eigen::Vector3d up;     ///< unit: its normal out of the material, of a cylinder in the middle of what is seen of it
    Eigen::Vector3d centre; ///< mean of its points, mm
    double radius = 0;      ///< of a cylinder, mm
    double share = 0;       ///< of the part's points that belong to it
};

/// Finds the plane, or the cylinder, that most of the points belong to: pcl::SACSegmentationFromNormals, whose random
/// numbers are always the same; a plane is then fitted to its points by least squares.
/// @param threshold  points no farther from it belong to it, mm
/// @throws InputError if there is none, and for a cylinder that is seen from all around, of which no side is up
FoundRegion find_region(const align::OrientedPoints& points, RegionShape shape, double threshold);

} // namespace fettle::place
