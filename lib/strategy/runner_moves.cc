// The moves of a run: along the passes, across, and over what stands between.

#include "strategy/runner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::strategy {
namespace {

/// Feeds relative to the job's: near F_max, and where there is little to grind.
constexpr double kMinFeedShare = 0.5, kMaxFeedShare = 2;
/// The side face meets no wall that takes more than this share of F_max.
constexpr double kMaxCrossingShare = 0.95;
/// It crosses fast where the stock takes no more than this share: much harder stock then stays below F_max, too.
constexpr double kMaxFastCrossingShare = 0.8;
/// A way is judged anew where the drives are farther off it than this share of a step.
constexpr double kMaxOffShare = 0.2;
/// What just exceeds a limit, relative to it.
constexpr double kJustAbove = 1e-6;
/// Share of F_max above which the wheel goes slower, and of F_min below which it goes faster.
constexpr double kSlowForceShare = 0.9, kFastForceShare = 1.2;
/// Slope of the rim where it meets the edge of a wall half as high as its radius: it climbs no steeper.
constexpr double kMaxClimb = 1.75;
/// A wheel that climbs a wall may come to these shares of F_max before the drives stand: it goes slower, and is lifted.
constexpr double kSlowClimbShare = 1.05, kMaxClimbShare = 1.1;
constexpr double kSteeper = 1.5; ///< the next climb relative to the last ones, where the wheel slows down
constexpr int kPiecesOnWall = 2; ///< of a step there: the force is read in the middle, too
/// What is left of the steepest climb after a step: walls go on behind an edge.
constexpr double kClimbMemory = 0.85;
/// Deceleration of drives that stop, mm/s²: a laboratory gantry with ball screws. A machine behind a driver does not
/// say its own.
constexpr double kAcceleration = 1000;
/// Slope that metal ahead may have where the wheel was set down on it.
constexpr double kUnknownSlope = 0.7;
/// A flatter slope is no wall, nor is one that adds less than this share of F_max over a step and the way to stop.
constexpr double kWallSlope = 0.2, kMinWallShare = 0.12;

/// What is known to stand no higher than this share of what may remain needs no grinding: it is as good as air.
constexpr double kAirShare = 0.5;

/// @param feed  mm/s   @return  mm
double braking_distance(double feed) { return feed * feed / (2 * kAcceleration); }
/// The feed from which the drives stop within a distance, mm/s. @param distance  mm
double stoppable_feed(double distance) { return std::sqrt(2 * kAcceleration * std::max(distance, 0.0)); }

} // namespace

/// Commanded tool point in this layer.
Eigen::Vector3d Runner::tool_point(int layer) const
{
    const double offset = plan::reference_offset(plan_.layers, layer) - wheel_wear_ - force_offset_;
    return reference_point_ + offset * Eigen::Vector3d::UnitZ();
}

/// Travels to a tool point of reference_point_, no higher over what is known of the stock than it needs.
void Runner::travel(const Action& action, const Eigen::Vector3d& reference)
{
    force_offset_ = 0;
    reference_point_ = reference;
    resume_from_trace(action);
    const Eigen::Vector3d from = machine_.status().commanded, to = tool_point(action.layer);
    record_move(machine_.travel_low(mark(action, event_), to, bound_.free_height(from, to, radius()),
                                    bound_.free_height(to, to, radius())),
                action.layer, 0);
}

void Runner::grind(const Action& action, const Eigen::Vector3d& reference)
{
    if (by_feed(action.layer)) return grind_controlled(action, reference);
    const double feed = feed_to(action, reference);
    const Eigen::Vector3d from = reference_point_;
    const int pieces = is_wall_ahead(feed_share_ * plan_.job.feed.rate) ? kPiecesOnWall : 1;
    for (int n = 1; n <= pieces && (n == 1 || decisive_force() <= plan_.job.force.max); ++n) {
        reference_point_ = from + (reference - from) * (double(n) / pieces);
        grind_at(action, feed);
    }
}

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

/// Grinds to the tool point of reference_point_.
void Runner::grind_at(const Action& action, double feed)
{
    resume_from_trace(action);
    record_move(machine_.grind(mark(action, event_), tool_point(action.layer), feed), action.layer, feed);
    event_ = Event::none;
}

/// Grinds in layer 1 with the feed-rate control, period by period.
void Runner::grind_controlled(const Action& action, const Eigen::Vector3d& reference)
{
    const Eigen::Vector3d from = reference_point_, motion = reference - from;
    const double length = motion.norm();
    for (double travelled = 0; travelled < length && (travelled == 0 || decisive_force() <= plan_.job.force.max);) {
        const double feed = is_wall_ahead(feed_control_.feed())
                                ? std::min(feed_control_.feed(), kMinFeedShare * plan_.job.feed.rate)
                                : feed_control_.feed();
        travelled = std::min(travelled + feed * feed_control_.period(), length);
        reference_point_ = from + motion * (travelled / length);
        const gantry::GantryStatus before = machine_.status();
        grind_at(action, feed);
        const gantry::GantryStatus& after = machine_.status();
        if (feed == feed_control_.feed()) // on a wall it is not the control's
            feed_control_.update(before.deflection, after.deflection, after.time - before.time);
    }
}

/// Crosses to the next pass in pieces of a step, along the surface between the two. Ends early if the wheel climbs
/// on something that is too high: the strategy goes up a layer at this position, and then on. Where the wheel's side
/// face could meet a wall that takes more than F_max, it is lifted over, and lowered, guarded, beside it. Above layer 1
/// it crosses as fast as it may, but for the end, beyond which the drives come before they turn into the pass: nothing
/// is to be ground between the passes. Where a wall stands beyond the end the last step is slow.
void Runner::cross(const Action& action)
{
    force_offset_ = 0;
    force_control_.begin_pass(path_.passes()[action.to.pass].along);
    const std::vector<Eigen::Vector3d> way = way_across(action.to);
    const double force_max = plan_.job.force.max, rate = plan_.job.feed.rate, fast = kMaxFeedShare * rate;
    const auto meets = [&](const std::vector<Eigen::Vector3d>& points, double feed, double share) {
        return max_force(points, action.layer, feed) > share * force_max;
    };
    if (meets(beyond(way, kMinFeedShare * rate), rate, kMaxCrossingShare)) return travel(action, way.back());
    const bool ends_at_wall = meets(beyond(way, rate), rate, kMaxCrossingShare);
    bool is_free = !meets(way, fast, kMaxFastCrossingShare);
    for (std::size_t i = 1; i < way.size() && (i == 1 || machine_.status().force <= force_max); ++i) {
        if (const Eigen::Vector3d off = off_the_way(); i > 1 && off.norm() > kMaxOffShare * plan_.step) {
            std::vector<Eigen::Vector3d> rest(way.begin() + std::ptrdiff_t(i) - 1, way.end());
            for (Eigen::Vector3d& at : rest) at += off;
            if (meets(rest, rate, kMaxCrossingShare)) return travel(action, way.back());
            is_free = is_free && !meets(rest, fast, kMaxFastCrossingShare);
        }
        const double left = (way.back() - way[i]).norm();
        crossing_share_ = is_free && left > braking_distance(fast) ? kMaxFeedShare : 1;
        if (ends_at_wall && i + 1 == way.size()) crossing_share_ = kMinFeedShare;
        grind(action, way[i]);
    }
}

/// How far the drives are beside the end of their last step: they round the corners of their path.
Eigen::Vector3d Runner::off_the_way() const
{
    const Eigen::Vector3d off = machine_.status().commanded - reference_point_;
    return {off.x(), off.y(), 0};
}

/// A way, and how far the drives come beyond its end at this feed.
std::vector<Eigen::Vector3d> Runner::beyond(std::vector<Eigen::Vector3d> way, double feed)
{
    const Eigen::Vector3d last = way.back() - way[way.size() - 2];
    way.push_back(way.back() + last.normalized() * braking_distance(feed));
    return way;
}

/// Reference points from here to the next pass.
std::vector<Eigen::Vector3d> Runner::way_across(const PathIndex& to) const
{
    const Eigen::Vector3d a = reference_point_, b = reference(to);
    const int pieces = std::max(1, int(std::ceil((b - a).head<2>().norm() / plan_.step)));
    // The path is a parabola through the tool point half-way: a straight line would cut into a convex surface.
    double crown = 0;
    if (pieces > 1) {
        const Eigen::Vector3d middle = path_.tool_point(path_.across_along((a + b) / 2));
        if (std::isfinite(middle.z())) crown = middle.z() - (a.z() + b.z()) / 2;
    }
    std::vector<Eigen::Vector3d> way = {a};
    for (int i = 1; i <= pieces; ++i) {
        const double s = double(i) / pieces;
        way.emplace_back(a + s * (b - a) + 4 * s * (1 - s) * crown * Eigen::Vector3d::UnitZ());
    }
    return way;
}

/// The largest force that stock of this hardness could put on the wheel on a way of reference points, N.
double Runner::max_force(std::vector<Eigen::Vector3d> way, int layer, double feed, double hardness) const
{
    const double up = tool_point(layer).z() - reference_point_.z();
    for (Eigen::Vector3d& at : way) at.z() += up;
    return bound_.max_force(way, radius(), feed, hardness);
}

/// Predicts the force on a wheel that goes along the passes, and is lifted over to the next.
ForcePrediction Runner::force_on_passes(double hardness) const
{
    return [this, hardness](const std::vector<PathIndex>& points, int layer) {
        double force = 0;
        for (std::size_t first = 0, end; first < points.size(); first = end) {
            std::vector<Eigen::Vector3d> way;
            for (end = first; end < points.size() && points[end].pass == points[first].pass; ++end)
                way.push_back(reference(points[end]));
            force = std::max(force, max_force(std::move(way), layer, plan_.job.feed.rate, hardness));
        }
        return force;
    };
}

/// Records the end of a move. A guarded descent may have stopped above the reference surface; a grinding step has
/// not, though a machine with look-ahead may not have reached its end yet.
void Runner::record_move(const gantry::GantryStatus& status, int layer, double feed)
{
    height_error_ = feed > 0 ? 0 : std::max(0.0, status.commanded.z() - tool_point(layer).z());
    const double duration = feed > 0 ? status.time - last_time_ : 0; // of grinding
    result_.force.add(status, layer, duration, plan_.job.force);
    impulse_ = (last_force_ + status.force) / 2 * duration;
    grinding_time_ += duration;
    wear_model_.add_force(status.force, duration);
    if (makes_up_for_wear()) wheel_wear_ = wear_model_.loss();
    last_time_ = status.time;
    last_feed_ = feed;
    lower_bound(status, feed);
    last_force_ = status.force;
    if (contact_watch_ && machine_.is_live()) contact_watch_->follow(status, feed);
}

/// The stock ends at the wheel's rim, where the wheel has been. Between two readings it may have been higher, by what
/// the peak force says; and the wheel has worn.
void Runner::lower_bound(const gantry::GantryStatus& status, double feed)
{
    const Eigen::Vector3d from = tip_;
    tip_ = status.commanded + (status.deflection + wear_model_.expected_loss()) * Eigen::Vector3d::UnitZ();
    const double along = (tip_ - from).head<2>().norm(), slope = along > 0 ? (tip_.z() - from.z()) / along : 0;
    if (feed > 0)
        is_climbing_ = slope > wall_slope();
    else // where it climbs, a layer up may not be enough
        is_climbing_ = is_climbing_ && event_ == Event::up && status.force > plan_.job.force.down;
    if (feed > 0)
        climb_ = std::max(slope, kClimbMemory * climb_);
    else if (status.force > plan_.job.force.min) // set down on metal, which may rise ahead
        climb_ = std::max(climb_, kUnknownSlope);
    if (!(feed > 0)) return bound_.lower(tip_, radius());
    const double reading = std::max(status.force, last_force_), above = std::max(status.peak_force - reading, 0.0);
    const Eigen::Vector3d up = above / plan_.job.force.stiffness * Eigen::Vector3d::UnitZ();
    bound_.lower(from + up, tip_ + up, radius());
}

/// Radius of the wheel as it was measured last, mm.
double Runner::radius() const { return result_.wheel_radius > 0 ? result_.wheel_radius : plan_.job.wheel.radius; }

} // namespace fettle::strategy
