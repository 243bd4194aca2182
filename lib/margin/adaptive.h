#pragma once

#include "job/job.h"
#include "sampling/touch_plan.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace fettle::margin {

/// Limits of adaptive touching.
struct AdaptiveLimits {
    int max_touches = 60;     ///< maximum number of touches
    double max_band = 0;      ///< stops once the predicted error band stays at or below this, mm; 0: never
    double confidence = 0.95; ///< of the predicted band
    int patience = 0; ///< stops once the mean band of so many touches is hardly below that of as many before; 0: never
    double min_distance = 0; ///< minimum between any two touches, mm; 0: a fiftieth of the sampling boundary's size
};

struct AdaptiveTouches {
    sampling::TouchPlan plan;
    Eigen::Matrix3Xd touches;                 ///< M, mm, in the order in which they were chosen
    Eigen::VectorXd band;                     ///< predicted after each touch, mm; NaN while there are too few to fit
    std::vector<Eigen::Vector2d> unreachable; ///< places where no surface was found
    bool band_reached = false;                ///< the band met its limit
    Eigen::Index layout = 0;                  ///< number of touches that were given, the first ones of the plan
};

/// Touches all places of a plan. @return  3xN, M, mm; z is NaN where no surface is found. Calls with a longer plan must
/// return the same heights for the places of earlier calls.
using ProbeFunction = std::function<Eigen::Matrix3Xd(const sampling::TouchPlan&)>;

/// Chooses touches in S \ B one after the other: the first few with the largest possible distances, then each where it
/// lowers the expected error band inside B most (Wang 2007, eq. 4-1), given the posterior of the fit to the touches
/// before it. The expectation is over fields drawn from the fit's covariance and its alternatives, each conditioned on
/// the new touch (simple kriging: Cressie 1993, 3.2). A place where no surface is found is not tried again.
/// @throws InputError if the job has no sampling boundary or S \ B no room, or if too few places can be touched
AdaptiveTouches touch_adaptively(const job::Job& job, const AdaptiveLimits& limits, const ProbeFunction& probe);

/// Touches a layout, and continues as touch_adaptively() if the band that its fit predicts is above the limit. If the
/// layout meets the limit, or has the maximum number of touches, its touches alone are returned.
/// @param touches  of the layout, M, mm, all of them found
AdaptiveTouches extend_layout(const job::Job& job, const sampling::TouchPlan& layout, const Eigen::Matrix3Xd& touches,
                              const AdaptiveLimits& limits, const ProbeFunction& probe);

} // namespace fettle::margin
