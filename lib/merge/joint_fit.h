#pragma once

#include "merge/growth.h"
#include "merge/pose_graph.h"

#include <vector>

namespace fettle::merge {

struct IndexPair {
    std::size_t a, b;
};

/// What two scans say about each other's pose.
struct JointPair {
    PoseEdge edge;                       ///< its own pose of least squares, and what it weighs
    double overlap_a = 0, overlap_b = 0; ///< shares of each scan's places that the other sees, too
    double rms = 0;                      ///< of the offsets, mm
};

/// All pairs at once.
struct JointFit {
    std::vector<JointPair> pairs;
    double variance_scale = 1; ///< covariance of the poses over that of the edges' informations
    double scatter = 1;        ///< root mean square of the offsets over what the scans' noise explains
};

/// A place on the surface, in the world.
struct SurfacePlace {
    Eigen::Vector3d place;  ///< mm
    Eigen::Vector3d normal; ///< unit, or zero where there is no direction
};

/// Places on the union of all placed scans, one in each cube of a grid. @param length  of the cubes, mm
std::vector<SurfacePlace> surface_places(const Scans& scans, const std::vector<std::optional<Place>>& places,
                                         double length);

/// Compares all scans at common places of the surface: the height there of each scan that sees it, by a
/// plane fitted to its points within one length. What the plane levels on curved faces it levels for all scans alike,
/// so that it cancels in their differences. Each pair's pose is that of least squares of its differences, with less
/// weight for those beyond the noise (Tukey's biweight). Where scans with weights w = 1/σ² see a place, the pair a, b
/// gets w_a w_b / Σ w: the weighted squares of all pairs' differences are those from the common mean, and no noise
/// counts twice. Only the points that planes share do, for which `variance_scale` makes up.
/// @param places  of all scans in `pairs`   @param length  radius of the planes, mm
JointFit fit_jointly(const Scans& scans, const std::vector<std::optional<Place>>& places,
                     const std::vector<IndexPair>& pairs, const std::vector<SurfacePlace>& surface, double length);

} // namespace fettle::merge
