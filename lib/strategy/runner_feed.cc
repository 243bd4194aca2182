// The feed of each step of a run, from the force of the last step, walls ahead and stock known to be free.

#include "strategy/runner_feed.h"

#include "strategy/runner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::strategy {
namespace {

/// Relative excess of a force that is just above a limit.
constexpr double kRelativeExcess = 1e-6;
/// Share of F_max above which the feed is reduced, and of F_min below which it is increased.
constexpr double kSlowForceShare = 0.9, kFastForceShare = 1.2;
/// Largest slope of a climb: that of the rim where it meets the edge of a wall half as high as its radius.
constexpr double kMaxClimb = 1.75;
/// Shares of F_max that a wheel on a wall may reach before the drives stop: above the first its feed is reduced, above
/// the second it is lifted.
constexpr double kSlowClimbShare = 1.05, kMaxClimbShare = 1.1;
constexpr double kClimbIncrease = 1.5; ///< expected slope of the next step relative to the steepest of the last ones
/// Minimum slope of a wall, and minimum share of F_max that it adds over a step and the braking distance.
constexpr double kWallSlope = 0.2, kMinWallShare = 0.12;
/// Stock known to be no higher than this share of what may remain needs no grinding: the wheel is in air there.
constexpr double kAirShare = 0.5;

/// The feed from which the drives stop within a distance, mm/s. @param distance  mm
double stoppable_feed(double distance) { return std::sqrt(2 * kDriveDeceleration * std::max(distance, 0.0)); }

} // namespace

/// The feed of the next step, mm/s. In layer 1 it depends on the air ahead. Above layer 1 it follows from the force of
/// the last step: higher where there is little to grind, if even a wall that the rim begins to climb does not take
/// F_max within the step; lower near F_max.
double Runner::feed_to(const Action& action, const Eigen::Vector3d& reference)
{
    const job::ForceRange& limits = plan_.job.force;
    const double rate = plan_.job.feed.rate, force = machine_.status().force;
    const double climb = limits.stiffness * kMaxClimb * (reference - reference_point_).norm();
    if (action.layer == 1)
        feed_share_ = action.event != Event::none || by_force(1) ? 1 : feed_along_pass(action, reference) / rate;
    else if (action.event != Event::none)
        feed_share_ = crossing_share_;
    else if (force > kSlowForceShare * limits.max)
        feed_share_ = kMinFeedShare;
    else if (force + climb > limits.max)
        feed_share_ = 1;
    else if (force < kFastForceShare * limits.min)
        feed_share_ = kMaxFeedShare;
    const double feed = std::min(feed_share_ * rate, std::max(rate, machine_.max_feed()));
    return is_wall_ahead(feed) ? std::min(feed, kMinFeedShare * rate) : feed;
}

/// The feed along a pass of layer 1, mm/s: the job's, or more through air.
double Runner::feed_along_pass(const Action& action, const Eigen::Vector3d& reference) const
{
    std::vector<Eigen::Vector3d> path = {reference_point_, reference};
    const std::vector<Eigen::Vector3d>& points = path_.passes()[action.to.pass].points;
    const int direction = strategy_.direction();
    double left = plan_.step + braking_distance(kMaxFeedShare * plan_.job.feed.rate);
    for (int n = action.to.point + direction; left > 0 && n >= 0 && n < int(points.size()); n += direction) {
        left -= (points[n] - path.back()).norm();
        path.push_back(points[n]);
    }
    return feed_in_air(std::move(path));
}

/// The feed in layer 1 on a path that the wheel has ground before, mm/s: the feed from which the drives stop, after a
/// step, before the first place where there may be stock; not below the job's.
/// @param path  reference points, ahead of the drives, from the end of their last step
double Runner::feed_in_air(std::vector<Eigen::Vector3d> path) const
{
    const double rate = plan_.job.feed.rate;
    const double fastest = std::min(kMaxFeedShare * rate, std::max(rate, machine_.max_feed()));
    path = extended(std::move(path), fastest); // the drives may pass its end
    path.front() += path_deviation();
    for (Eigen::Vector3d& at : path) at.z() += tool_point(1).z() - reference_point_.z();
    const double air = std::min(kAirShare * settings_.max_remaining, plan_.job.force.min / plan_.job.force.stiffness);
    const double free = bound_.free_length(path, radius(), air);
    return std::clamp(stoppable_feed(free - plan_.step), rate, fastest);
}

/// Whether the force could exceed F_max in the next step, on a wall somewhat steeper than the last slopes.
bool Runner::is_wall_ahead(double feed) const
{
    return climb_ > wall_slope() &&
           force_after_step(feed, kClimbIncrease * climb_) > kSlowClimbShare * plan_.job.force.max;
}

/// Minimum slope of a wall.
double Runner::wall_slope() const
{
    const double flat = force_after_step(plan_.job.feed.rate, 0), steep = force_after_step(plan_.job.feed.rate, 1);
    return std::min(kWallSlope, kMinWallShare * plan_.job.force.max / (steep - flat));
}

/// The force when the drives stop after another step, if the wheel climbs at this slope, N.
double Runner::force_after_step(double feed, double slope) const
{
    const double distance = plan_.step + braking_distance(feed);
    return machine_.status().force + plan_.job.force.stiffness * slope * distance;
}

/// The force by which the strategy decides, N: after a guarded descent the force at the target. On a wall that the
/// wheel would climb too far in the next step, or within the braking distance, it is just above F_max.
double Runner::decisive_force() const
{
    const job::ForceRange& limits = plan_.job.force;
    const double force = machine_.status().force + limits.stiffness * height_error_;
    const double slow = kMinFeedShare * plan_.job.feed.rate;
    const double distance = std::max(plan_.step + braking_distance(slow), braking_distance(last_feed_));
    const bool climbs = is_climbing_ && climb_ > wall_slope() &&
                        machine_.status().force + limits.stiffness * climb_ * distance > kMaxClimbShare * limits.max;
    return climbs ? std::max(force, limits.max * (1 + kRelativeExcess)) : force;
}

} // namespace fettle::strategy
