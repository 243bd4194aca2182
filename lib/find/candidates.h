#pragma once

#include "find/bounds.h"
#include "find/height_map.h"

#include <vector>

namespace fettle::find {

/// A region of a height map that may be an anomaly.
struct Candidate {
    cv::Rect box;       ///< in the map
    Mask mask;          ///< of the box's size
    double rank = 0;    ///< by contrast to what surrounds it, and how far that encloses it; higher: sooner verified
    int cells = 0;      ///< of the mask
    double texture = 0; ///< robust standard deviation of the smoothed residual of its sheet, by the filter's width, mm
};

/// Whether two candidates have more than a share of the cells in common that any of them has.
bool overlap(const Candidate& a, const Candidate& b, double share);

/// Regions that stand out of the surfaces of filters at several scales: of each sheet of the map by
/// regression_filter(), of the map by ball_opening(). Not one threshold cuts them out, but each of a rising row:
/// features of the part inflate a single one. Highest rank first; of near duplicates the first.
std::vector<Candidate> find_candidates(const HeightMap& map, const SearchBounds& bounds);

} // namespace fettle::find
