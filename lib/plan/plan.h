#pragma once

#include "job/job.h"
#include "plan/layers.h"
#include "plan/staircase.h"
#include "surface/surface.h"
#include "json/document.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle {

/// No loop of the strategy is endless: reaching one of these is an error with the state reported.
struct Bounds {
    int layers = 0;          ///< the highest; its reference surface is still below the safe height
    int re_cuts = 200;       ///< of one cut. A cut halves what stands over its reference, give or take
    int coverings = 100;     ///< of layer 1
    double time = 48 * 3600; ///< of the machine, s
    int steps = 5000000;     ///< force readings
};

/// Between the passes this share of the tolerance may stand; the rest is for what the strategy leaves under the wheel.
inline constexpr double kLeftoverPerTolerance = 0.5;

/// Everything that the strategy needs to grind one region ("kind": "plan"). mm, N; points in the frame M.
struct Plan {
    Job job;
    Surface surface; ///< desired, after the shift
    Layers layers;
    Eigen::Vector3d start;    ///< initial point, on the boundary of B (Wang 2007, eq. 5-4 to 5-6)
    std::vector<Pass> passes; ///< in the pass frame (plan/wheel_section.h)
    double step = 0.5;        ///< between two readings of the force, mm: 50 a second at 1 in/s
    Bounds bounds;
};

/// @throws InputError if the wheel does not fit the surface, or the safe height does not clear it
Plan make_plan(const Job& job, const Surface& surface);

Plan read_plan(const std::string& path);
Plan parse_plan(json::Reader reader);

/// What a machine is set up for: a plan's job, or a job for which there is no plan yet.
struct Work {
    Job job;
    bool planned = false;
};
/// Reads a plan or a job.
Work read_work(const std::string& path);
json::Value to_json(const Plan& plan);

} // namespace fettle
