#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "surface/surface.h"
#include "units/units.h"
#include "json/document.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace fettle::strategy {

/// A simulated run with one F_down. N, s.
struct ForceDownTrial {
    double force_down = 0;
    bool finished = false;
    std::string failure; ///< of a run that did not finish
    double machine_time = 0;
    double peak_force = 0;
    int layers = 0; ///< highest layer
    int raises = 0, re_cuts = 0, skipped_re_cuts = 0;
};

struct ForceDownChoice {
    std::vector<ForceDownTrial> trials; ///< by ascending F_down
    std::size_t chosen = 0;             ///< index of the fastest one that finishes
};

/// Makes the gantry of a trial; its job has the F_down that is tried.
using MakeGantry = std::function<std::unique_ptr<gantry::Gantry>(const job::Job& job)>;

/// Chooses F_down by simulation (Wang 2007, 5.3.1, leaves it to the operator): the part is ground with several
/// values from F_min to just below F_max on a simulated gantry, and the value with the shortest machine time is
/// chosen, the smallest of equal ones. With a higher F_down cuts are repeated less often, but layers are closer: which
/// matters more depends on how fast the stock yields.
/// @param make_gantry  a simulated gantry on the part with its anomaly; called from several threads
/// @throws InputError if the work finishes with none of them, or as plan::make_plan()
ForceDownChoice choose_force_down(const job::Job& job, const surface::Surface& surface, const MakeGantry& make_gantry);

/// The trials for a report, in the job's units.
json::Value to_json(const ForceDownChoice& choice, const units::Units& units);

} // namespace fettle::strategy
