#pragma once

#include "sampling/hillclimb.h"
#include "sampling/scan.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fettle::margin {

/// Settings of the search for the best touches on a known surface.
struct TouchSearch {
    Eigen::Index touches = 0;        ///< 0: as many as plan_freeform() takes
    double spacing = 0;              ///< of the candidate places, mm; 0: the default of candidate_touches()
    std::string method = "griddata"; ///< or "bspline-wang": the method whose error band inside B is minimised
    int mutations = 500;             ///< before the discards
    /// Sharpness of the acceptance probability, 1/mm; by default a discard that widens the band by the probe's accuracy
    /// is accepted once in a hundred times.
    std::optional<double> sharpness;
    std::uint64_t seed = 1;
};

struct BestTouches {
    sampling::TouchPlan plan;
    Eigen::Index candidates = 0; ///< number of candidate places
    sampling::HillClimbResult search_result;
};

/// The touches that minimise the error band (Wang 2007, Appendix A: hill_climb) on a surface that is also known beneath
/// the anomaly.
/// @throws InputError naming a place inside B without a surface, and the errors of hill_climb()
BestTouches best_touches(const sampling::Scan& surface, const job::Job& job, const TouchSearch& search);

} // namespace fettle::margin
