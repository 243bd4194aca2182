#pragma once

#include "job/job.h"
#include "plan/layers.h"
#include "plan/staircase.h"
#include "surface/surface.h"
#include "json/document.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::plan {

/// Limits of the strategy's loops. Exceeding one is an error, with a report of the state.
struct StrategyLimits {
    int layers = 0;          ///< highest layer: its reference surface is still below the safe height
    int re_cuts = 200;       ///< repetitions of one cut, each of which removes about half of the height error
    int coverings = 100;     ///< repetitions of layer 1
    double time = 48 * 3600; ///< machine time, s
    int steps = 5000000;     ///< number of force readings
};

/// Scallop height between the passes as a fraction of the tolerance. The rest is for the error under the wheel.
inline constexpr double kScallopPerTolerance = 0.5;

/// The input of the strategy for one region ("kind": "plan"). mm, N; points in the frame M.
struct Plan {
    job::Job job;
    surface::Surface surface; ///< desired surface, after the shift
    Layers layers;
    Eigen::Vector3d start;    ///< initial point, on the boundary of B (Wang 2007, eq. 5-4 to 5-6)
    std::vector<Pass> passes; ///< in the pass frame (plan/wheel_section.h)
    double step = 0.5;        ///< distance between force readings, mm: 50 per second at 1 in/s
    StrategyLimits bounds;
};

/// Plans the layers and passes of a job.
/// @throws InputError if the wheel does not fit the surface, or the safe height is not above it
Plan make_plan(const job::Job& job, const surface::Surface& surface);

/// @throws InputError with the key's path; also if layers or passes do not agree with the job
Plan read_plan(const std::string& path);
Plan parse_plan(json::Reader reader);

/// A job from a file of either kind, "job" or "plan".
struct JobOrPlan {
    job::Job job;
    bool is_plan = false;
};
JobOrPlan read_job_or_plan(const std::string& path);
json::Value to_json(const Plan& plan);

/// Report of a plan: layers, passes, and the length and the time of one covering, in the job's units.
json::Value report_json(const Plan& plan);

} // namespace fettle::plan
