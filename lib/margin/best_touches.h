#pragma once

#include "sampling/hillclimb.h"
#include "sampling/scan.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fettle {

/// What a search for the best touches on a known surface goes by.
struct TouchSearch {
    Eigen::Index touches = 0;        ///< 0: as many as plan_freeform() takes
    double spacing = 0;              ///< of the places to choose from, mm; 0: as candidate_touches says
    std::string method = "griddata"; ///< or "bspline-wang": whose error band inside B is lowered
    int mutations = 500;             ///< before the discards
    std::optional<double> sharpness; ///< 1/mm; else a discard that costs the probe's accuracy is accepted once in a
                                     ///< hundred times
    std::uint64_t seed = 1;
};

struct BestTouches {
    TouchPlan plan;
    Eigen::Index candidates = 0; ///< places to choose from
    HillClimbed found;
};

/// The touches with the least error band (Wang 2007, Appendix A: hill_climb) on a surface that is known beneath the
/// anomaly, too.
/// @throws InputError naming a place inside B without a surface, or as hill_climb
BestTouches best_touches(const Scan& surface, const Job& job, const TouchSearch& search);

} // namespace fettle
