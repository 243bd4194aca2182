#pragma once

#include "job/job.h"
#include "sampling/touch_plan.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace fettle {

/// When to stop touching.
struct AdaptiveLimits {
    int most_touches = 60;    ///< no more than that
    double band = 0;          ///< enough when the predicted error band stays at most that, mm; 0: never
    double confidence = 0.95; ///< of the predicted band
    double distance = 0;      ///< between any two touches at least, mm; 0: a fiftieth of the sampling boundary's size
};

struct AdaptiveTouches {
    TouchPlan plan;
    Eigen::Matrix3Xd touches;                 ///< M, mm, in the order in which they were chosen
    Eigen::VectorXd band;                     ///< predicted after each touch, mm; NaN while too few to fit
    std::vector<Eigen::Vector2d> unreachable; ///< places where no surface was found
    bool enough = false;                      ///< was the band reached?
};

/// Touches all places of a plan; z is NaN where no surface is found. Those touched before must come out the same.
using ProbePlan = std::function<Eigen::Matrix3Xd(const TouchPlan&)>;

/// Chooses touches in S \ B one after the other: the first few as far apart as they can be, then each where it lowers
/// the expected error band inside B most (Wang 2007, eq. 4-1), given all that the fit to those before leaves possible.
/// That expectation is over fields drawn from the fit's covariance and its alternatives, each corrected by what the new
/// touch would say of it (Cressie 1993, 3.2: simple kriging). A place where nothing is found is not tried again.
/// @throws InputError if the job has no sampling boundary or S \ B no room, or if too few places can be touched
AdaptiveTouches touch_adaptively(const Job& job, const AdaptiveLimits& limits, const ProbePlan& probe);

} // namespace fettle
