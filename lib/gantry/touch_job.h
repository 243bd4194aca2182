#pragma once

#include "gantry/touch.h"
#include "margin/adaptive.h"
#include "margin/best_touches.h"
#include "json/document.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::gantry {

/// How the touch points of a job are chosen.
enum class TouchStrategy {
    extended,  ///< wang, then adaptive while the predicted band exceeds the job's tolerance; adaptive alone where the
               ///< layout has no room on one side
    wang,      ///< by the rules of Wang 2007, 4.4.4
    adaptive,  ///< one after the other (margin/adaptive.h)
    hillclimb, ///< the best subset of many candidates on a known surface (margin/best_touches.h)
};

struct TouchRequest {
    TouchStrategy strategy = TouchStrategy::extended;
    int lines = 0; ///< wang and extended, free-form jobs: number of lines in each direction; 0: after eq. 4-5
    bool sampling_boundary = false; ///< wang: touch the points of the sampling boundary, too
    int max_touches = 60;           ///< extended, adaptive: maximum number of touches
    margin::TouchSearch search;     ///< hillclimb
    bool plan_only = false;         ///< nothing is touched; not for adaptive
};

/// Touches of a job.
struct JobTouches {
    sampling::TouchPlan plan;
    Eigen::Matrix3Xd touches;                        ///< M, mm, in the order of the plan; z is NaN if not touched
    std::vector<Eigen::Index> order;                 ///< of probing
    std::optional<margin::AdaptiveTouches> adaptive; ///< how they were chosen, if so
    std::optional<margin::BestTouches> best;         ///< how they were chosen, if so
    std::vector<std::string> warnings;
};

/// Chooses the touch points of a job and touches a part there.
/// @param part  nullptr: none, then the heights are those of the job
/// @throws InputError if the strategy does not suit the job or the part, or a touch finds no surface
JobTouches touch_job(const job::Job& job, const TouchedPart* part, const TouchRequest& request);

/// The report of fettle-sample; lengths in the job's units.
json::Value to_json(const JobTouches& result, const job::Job& job);

} // namespace fettle::gantry
