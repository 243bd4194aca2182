#pragma once

#include "find/candidates.h"
#include "find/evidence.h"
#include "find/height_map.h"

#include <optional>

namespace fettle::find {

/// A candidate that stands over a surface fitted to the metal around it.
struct Verified {
    cv::Rect window; ///< in the map: the candidate and the ring around it
    Mask mask;       ///< of the window's size
    Mask with_rim;   ///< the same with cells around that only smoothing may have raised: B goes around them
    Image height;    ///< over the surface beneath, all over the window, mm; NaN: nothing seen
    Evidence evidence;
    int factor = 1; ///< a thick candidate is verified in cells so many times as long
    int growth = 0; ///< of those cells around the mask: their mean still stands over the surface
    double probability = 0;
};

/// Fits the surface beneath a candidate to the ring around it, takes the region anew from what stands over that
/// surface, and repeats both until the region stays (at most six times). Then the evidence is measured.
/// @param others  cells of all candidates, which are kept out of rings
/// @return  nothing if no region remains, or its evidence is not plausible
std::optional<Verified> verify(const HeightMap& map, const Candidate& candidate, const Mask& others,
                               const SearchBounds& bounds);

/// Verifies all candidates, in parallel, each in cells of which some dozens lie across it: finer ones say no more about
/// the surface beneath, and cost time by their square. @return  those that remain, in the candidates' order
std::vector<Verified> verify_all(const HeightMap& map, const std::vector<Candidate>& candidates,
                                 const SearchBounds& bounds);

} // namespace fettle::find
