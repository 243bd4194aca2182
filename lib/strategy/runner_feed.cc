// The feed of a run, step by step: what the force of the last step, walls ahead and known air allow.

#include "strategy/runner_feed.h"

#include "strategy/runner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::strategy {
namespace {

/// What just exceeds a limit, relative to it.
constexpr double kJustAbove = 1e-6;
/// Share of F_max above which the wheel goes slower, and of F_min below which it goes faster.
constexpr double kSlowForceShare = 0.9, kFastForceShare = 1.2;
/// Slope of the rim where it meets the edge of a wall half as high as its radius: it climbs no steeper.
constexpr double kMaxClimb = 1.75;
/// A wheel that climbs a wall may come to these shares of F_max before the drives stand: it goes slower, and is lifted.
constexpr double kSlowClimbShare = 1.05, kMaxClimbShare = 1.1;
constexpr double kSteeper = 1.5; ///< the next climb relative to the last ones, where the wheel slows down
/// A flatter slope is no wall, nor is one that adds less than this share of F_max over a step and the way to stop.
constexpr double kWallSlope = 0.2, kMinWallShare = 0.12;
/// What is known to stand no higher than this share of what may remain needs no grinding: it is as good as air.
constexpr double kAirShare = 0.5;

/// The feed from which the drives stop within a distance, mm/s. @param distance  mm
double stoppable_feed(double distance) { return std::sqrt(2 * kDriveDeceleration * std::max(distance, 0.0)); }

} // namespace

/// In layer 1 the feed along a pass depends on known air. Above it the force of the last step sets the feed of the
/// next: faster where there is little to grind, if even a wall that the rim begins to climb does not take F_max within
/// the step; slower near F_max.
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

/// The job's feed, or more along a pass of layer 1 through known air, mm/s.
double Runner::feed_along_pass(const Action& action, const Eigen::Vector3d& reference) const
{
    std::vector<Eigen::Vector3d> way = {reference_point_, reference};
    const std::vector<Eigen::Vector3d>& points = path_.passes()[action.to.pass].points;
    const int direction = strategy_.direction();
    double left = plan_.step + braking_distance(kMaxFeedShare * plan_.job.feed.rate);
    for (int n = action.to.point + direction; left > 0 && n >= 0 && n < int(points.size()); n += direction) {
        left -= (points[n] - way.back()).norm();
        way.push_back(points[n]);
    }
    return feed_in_air(std::move(way));
}

/// In layer 1, on a way where the wheel has been before and has left nothing to grind: the feed from which the drives
/// stop, after a step, before the first place where there may be something; not below the job's, mm/s.
/// @param way  reference points, ahead of the drives, from the end of their last step on
double Runner::feed_in_air(std::vector<Eigen::Vector3d> way) const
{
    const double rate = plan_.job.feed.rate;
    const double fastest = std::min(kMaxFeedShare * rate, std::max(rate, machine_.max_feed()));
    way = beyond(std::move(way), fastest); // the drives may come beyond its end
    way.front() += off_the_way();
    for (Eigen::Vector3d& at : way) at.z() += tool_point(1).z() - reference_point_.z();
    const double air = std::min(kAirShare * settings_.max_remaining, plan_.job.force.min / plan_.job.force.stiffness);
    const double free = bound_.free_length(way, radius(), air);
    return std::clamp(stoppable_feed(free - plan_.step), rate, fastest);
}

/// Whether the next step could climb above F_max on a wall somewhat steeper than what was met lately.
bool Runner::is_wall_ahead(double feed) const
{
    return climb_ > wall_slope() && force_after_step(feed, kSteeper * climb_) > kSlowClimbShare * plan_.job.force.max;
}

/// The flattest slope that is a wall.
double Runner::wall_slope() const
{
    const double flat = force_after_step(plan_.job.feed.rate, 0), steep = force_after_step(plan_.job.feed.rate, 1);
    return std::min(kWallSlope, kMinWallShare * plan_.job.force.max / (steep - flat));
}

/// The force when the drives stand after another step, if the wheel climbs at this slope, N.
double Runner::force_after_step(double feed, double slope) const
{
    const double way = plan_.step + braking_distance(feed);
    return machine_.status().force + plan_.job.force.stiffness * slope * way;
}

/// The force by which the strategy decides, N: after a guarded descent that of the target; on a wall that the wheel
/// would climb too far with the next step, or before drives that were fast stand, what is just too much.
double Runner::decisive_force() const
{
    const job::ForceRange& limits = plan_.job.force;
    const double force = machine_.status().force + limits.stiffness * height_error_;
    const double slow = kMinFeedShare * plan_.job.feed.rate;
    const double way = std::max(plan_.step + braking_distance(slow), braking_distance(last_feed_));
    const bool climbs = is_climbing_ && climb_ > wall_slope() &&
                        machine_.status().force + limits.stiffness * climb_ * way > kMaxClimbShare * limits.max;
    return climbs ? std::max(force, limits.max * (1 + kJustAbove)) : force;
}

} // namespace fettle::strategy
