#pragma once

#include "belt/assess.h"
#include "belt/belt_grinding.h"

#include <optional>
#include <vector>

namespace fettle::belt {

struct BeltPlanOptions {
    BeltOptions belt;
    bool by_force = false;          ///< plan the force of each contact point, otherwise its feed
    double min = 1, max = 100;      ///< limits of the planned value, N or mm/s, > 0
    double target_displacement = 0; ///< target displacement after grinding, mm
    double smoothness = 0.01;       ///< weight of the smoothing term, mm: see plan_belt()
    int max_rounds = 8;             ///< max. number of iterations
    /// The share of the area within is what counts; without it the root mean square of the error.
    std::optional<ToleranceRange> tolerance;
};

/// A path whose removal meets the allowance as well as its limits allow.
struct BeltPlan {
    std::vector<BeltPoint> path;
    double constant = 0; ///< best force or feed if all points have the same, N or mm/s
    /// Root mean square of displacement - target over the surfels reached, mm: before grinding, after grinding with the
    /// constant, and as planned.
    double rms_before = 0, rms_constant = 0, rms_planned = 0;
    /// Share of the area of all surfels that is within BeltPlanOptions::tolerance.
    struct Within {
        double before, constant, planned;
    };
    std::optional<Within> within;               ///< without a tolerance nothing
    double time_constant = 0, time_planned = 0; ///< of the path, s
    Eigen::Index touched = 0;                   ///< surfels with any removal
    /// Surfels that lose at least a quarter of the median removal with the constant. The rest of those touched lie at
    /// the rim of the contact or around an edge, and belong to another pass.
    Eigen::Index reached = 0;
    Eigen::Index at_min = 0, at_max = 0; ///< points whose force or feed is at its lower or upper limit
    int rounds = 0;                      ///< iterations
    bool converged = false;
};

/// Plans the force or feed of each contact point. A grinding simulation gives the removal of each surfel at each point,
/// which for small changes is linear in the force, or in the inverse feed. The best values within the limits therefore
/// solve a bounded least-squares problem: Σ (displacement - target)² over the surfels reached + Σ smoothness² (change
/// from a point to the next one of its run / mean)². Simulation and solution alternate until the error stops falling.
///
/// With a tolerance the squares get weights (iteratively re-weighted least squares, Holland & Welsch 1977): the area of
/// the surfel, times the derivative of the loss x⁴ / (1 + x⁴) by x², with the error x in half widths of the range from
/// its middle, or in multiples of the root mean square if that is more. It is largest at the limits: what lies well
/// within has little to gain, and what no feed brings back does not spoil its neighbours. What is kept is the largest
/// share of the area of all surfels within.
/// @param surfels  before grinding
/// @throws InputError as grind(), if forces are planned for a point with a given depth, and if nothing is removed
BeltPlan plan_belt(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                   const BeltPlanOptions& options, const core::Progress& progress = {});

} // namespace fettle::belt
