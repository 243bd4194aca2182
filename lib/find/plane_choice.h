#pragma once

#include "find/find.h"
#include "find/height_map.h"
#include "find/ring_fit.h"
#include "job/job.h"

namespace fettle::find {

/// B with as many corners, which are a plane's touches, as the tolerance needs. The error of one touch is the probe's
/// and, as far as the metal around scatters about the surface beneath, that of the place it falls on.
/// @param map  of the part, in the anomaly's frame   @param beneath  the surface beneath, fitted to the metal around
/// @param settings  probe and tolerance
/// @return  2xN, mm, the shape of B
Eigen::Matrix2Xd with_plane_corners(const FoundAnomaly& anomaly, const HeightMap& map, const RingFit& beneath,
                                    const job::Job& settings);

/// Whether a plane through touches at B's corners is expected to leave no more on the mean than a free-form surface
/// does, and to cut no more than the tolerance anywhere. Expected errors are compared: with a limit on the bend alone,
/// two outlines of one anomaly would get different surfaces, whose errors differ by a factor of two.
/// @param anomaly  its B has the corners that are touched   @param map, beneath, settings  as above
bool is_plane_better(const FoundAnomaly& anomaly, const HeightMap& map, const RingFit& beneath,
                     const job::Job& settings);

} // namespace fettle::find
