#pragma once

#include "find/candidates.h"
#include "find/evidence.h"
#include "find/height_map.h"

#include <optional>

namespace fettle::find {

/// A candidate that rises above a surface fitted to the metal around it.
struct Verified {
    cv::Rect window; ///< in the map: the candidate and the ring around it
    Mask mask;       ///< of the window's size
    Mask with_rim;   ///< mask and the cells around it that only smoothing may have raised: B encloses them
    Image height;    ///< over the surface beneath, in the whole window, mm; NaN: not seen
    Evidence evidence;
    int factor = 1;          ///< a thick candidate is verified in cells so many times as long
    int growth = 0;          ///< shells of such cells around the mask whose mean is still above the surface
    double score = 0;        ///< by its evidence; set_probabilities() lowers it for signs of a feature by design
    int doubtful_others = 0; ///< doubtful finds beside it; with the probability set by set_probabilities()
    double probability = 0;
    double probability_by_evidence = 0; ///< without these signs; set by set_probabilities()
    bool has_crease = false;            ///< in the surface beneath
    bool is_converged = false;          ///< the region hardly changed in the last step
    int alike = 0; ///< finds of the view that are like it, a pattern of the part; set by set_probabilities()
};

/// Verifies all candidates, in parallel: fits the surface beneath each to the ring around it, segments the region again
/// where the heights rise above that surface, and repeats both until the region converges (at most six times). Then the
/// evidence is measured. A candidate that reaches the region of another with a higher rank is a duplicate. Thick
/// candidates are verified in cells of which some dozens lie across them: finer cells determine the surface beneath no
/// better, and cost time by their square.
/// @return  the candidates with plausible evidence, in their order, without probabilities
std::vector<Verified> verify_all(const HeightMap& map, const std::vector<Candidate>& candidates,
                                 const SearchBounds& bounds);

} // namespace fettle::find
