#pragma once

#include "belt/belt_grinding.h"

#include <vector>

namespace fettle {

struct BeltPlanOptions {
    BeltOptions belt;
    bool by_force = false;      ///< the force of each contact point is chosen; otherwise its feed
    double least = 0, most = 0; ///< N or mm/s, > 0
    double wanted = 0;          ///< displacement to be left, mm
    double smoothness = 0.01;   ///< mm: see plan_belt()
    int rounds = 8;             ///< at most
};

/// A path whose removal meets the allowance as well as it can.
struct BeltPlan {
    std::vector<BeltPoint> path;
    double constant = 0; ///< the best force or feed of all points alike, N or mm/s
    /// Root mean square of displacement - wanted over the surfels reached, mm: as they are, ground with the constant,
    /// ground as planned.
    double rms_before = 0, rms_constant = 0, rms_planned = 0;
    double time_constant = 0, time_planned = 0; ///< of the path, s
    Eigen::Index touched = 0;                   ///< surfels
    /// Those that lose at least a quarter of the median of all that are touched, with the constant. The others lie at
    /// the rim of the contact, or around an edge, and are for another pass.
    Eigen::Index reached = 0;
    Eigen::Index at_least = 0, at_most = 0; ///< points whose force or feed is at its limit
    int rounds = 0;
    bool converged = false;
};

/// Chooses force or feed of each contact point. A grinding simulation says what each point takes from each surfel; for
/// small changes that is linear in the force, or in the inverse feed, so that the best ones within the limits are a
/// bounded least-squares problem: Σ (displacement - wanted)² over the surfels reached + Σ smoothness² (change from a
/// point to the next of its run / mean)². Then the simulation is made anew with them, until the error shrinks no more.
/// @param surfels  as before grinding
/// @throws InputError as grind(), if a point is pressed by depth while forces are chosen, and if nothing is taken
BeltPlan plan_belt(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                   const BeltPlanOptions& options, const Progress& progress = {});

} // namespace fettle
