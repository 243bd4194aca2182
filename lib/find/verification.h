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
    int factor = 1;          ///< a thick candidate is verified in cells so many times as long
    int growth = 0;          ///< of those cells around the mask: their mean still stands over the surface
    double score = 0;        ///< by its evidence; set_probabilities() takes off what speaks for a feature by design
    int doubtful_others = 0; ///< doubtful finds beside it; with the probability set by set_probabilities()
    double probability = 0;
    double probability_by_evidence = 0; ///< if it is no feature by design; set by set_probabilities()
    bool has_crease = false;            ///< in the surface beneath
    int alike = 0; ///< finds beside it that are like it, a pattern of the part; set by set_probabilities()
};

/// Verifies all candidates, in parallel: fits the surface beneath each to the ring around it, takes the region anew
/// from what stands over that surface, and repeats both until the region stays (at most six times). Then the evidence
/// is measured. What comes to a region where another of a higher rank has been is that one again. Each is verified in
/// cells of which some dozens lie across it: finer ones say no more about the surface beneath, and cost time by their
/// square.
/// @return  those that remain and whose evidence is plausible, in the candidates' order, without probabilities
std::vector<Verified> verify_all(const HeightMap& map, const std::vector<Candidate>& candidates,
                                 const SearchBounds& bounds);

} // namespace fettle::find
