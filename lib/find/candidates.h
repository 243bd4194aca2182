#pragma once

#include "find/bounds.h"
#include "find/height_map.h"

#include <vector>

namespace fettle::find {

/// A region of a height map that may be an anomaly.
struct Candidate {
    cv::Rect box;       ///< in the map
    Mask mask;          ///< of the box's size
    double rank = 0;    ///< by contrast to its surroundings, and by how far they enclose it
    int cells = 0;      ///< of the mask
    double texture = 0; ///< robust standard deviation of the smoothed residual of its sheet, by the filter's width, mm
};

/// Whether the intersection over union of two candidates exceeds a share.
bool overlap(const Candidate& a, const Candidate& b, double share);

/// Regions above the surfaces of filters at several scales: of each sheet of the map by regression_filter(), of the
/// whole map by ball_opening(). They are segmented by several thresholds, since features of the part would inflate a
/// single one. Highest rank first; of near duplicates the first.
std::vector<Candidate> find_candidates(const HeightMap& map, const SearchBounds& bounds);

} // namespace fettle::find
