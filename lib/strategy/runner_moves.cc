// The moves of a run: along the passes, from pass to pass, and over stock between them.

#include "strategy/runner.h"
#include "strategy/runner_feed.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::strategy {
namespace {

/// Share of F_max that the side face of the wheel may take.
constexpr double kMaxCrossingShare = 0.95;
/// Share of F_max up to which the wheel crosses fast: the force then stays below F_max in much harder stock, too.
constexpr double kMaxFastCrossingShare = 0.8;
/// Deviation of the drives from their path, in steps, above which the forces on it are predicted again.
constexpr double kMaxDeviationSteps = 0.2;
constexpr int kPiecesOnWall = 2; ///< of a step on a wall: the force is read in the middle, too
/// Decay per step of the steepest slope: walls continue behind an edge.
constexpr double kClimbMemory = 0.85;
/// Assumed slope of the metal ahead where the wheel was lowered onto it.
constexpr double kAssumedSlope = 0.7;

} // namespace

/// Commanded tool point in this layer.
Eigen::Vector3d Runner::tool_point(int layer) const
{
    const double offset = plan::reference_offset(plan_.layers, layer) - wheel_wear_ - force_offset_;
    return reference_point_ + offset * Eigen::Vector3d::UnitZ();
}

/// Travels to a tool point, no higher above the bound of the stock than necessary.
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
        if (feed == feed_control_.feed()) // false on a wall, where the feed is reduced
            feed_control_.update(before.deflection, after.deflection, after.time - before.time);
    }
}

/// Crosses to the next pass in pieces of a step, along the surface between the two. It ends early if the force exceeds
/// F_max: the strategy then goes up a layer at this position and continues. Where the wheel's side face could meet a
/// wall that takes more than F_max, the wheel is lifted over it and lowered, guarded, beside it. Above layer 1 it
/// crosses fast, since nothing is to be ground between the passes, but for the end, which the drives pass before they
/// turn. If there is a wall beyond the end, the last step is slow.
void Runner::cross(const Action& action)
{
    force_offset_ = 0;
    force_control_.begin_pass(path_.passes()[action.to.pass].along);
    const std::vector<Eigen::Vector3d> path = crossing_path(action.to);
    const double force_max = plan_.job.force.max, rate = plan_.job.feed.rate, fast = kMaxFeedShare * rate;
    const auto meets = [&](const std::vector<Eigen::Vector3d>& points, double feed, double share) {
        return max_force(points, action.layer, feed) > share * force_max;
    };
    if (meets(extended(path, kMinFeedShare * rate), rate, kMaxCrossingShare)) return travel(action, path.back());
    const bool ends_at_wall = meets(extended(path, rate), rate, kMaxCrossingShare);
    bool is_free = !meets(path, fast, kMaxFastCrossingShare);
    for (std::size_t i = 1; i < path.size() && (i == 1 || machine_.status().force <= force_max); ++i) {
        if (const Eigen::Vector3d off = path_deviation(); i > 1 && off.norm() > kMaxDeviationSteps * plan_.step) {
            std::vector<Eigen::Vector3d> rest(path.begin() + std::ptrdiff_t(i) - 1, path.end());
            for (Eigen::Vector3d& at : rest) at += off;
            if (meets(rest, rate, kMaxCrossingShare)) return travel(action, path.back());
            is_free = is_free && !meets(rest, fast, kMaxFastCrossingShare);
        }
        const double left = (path.back() - path[i]).norm();
        crossing_share_ = is_free && left > braking_distance(fast) ? kMaxFeedShare : 1;
        if (ends_at_wall && i + 1 == path.size()) crossing_share_ = kMinFeedShare;
        grind(action, path[i]);
    }
}

/// Horizontal deviation of the drives from the end of their last step: they round the corners of their path.
Eigen::Vector3d Runner::path_deviation() const
{
    const Eigen::Vector3d off = machine_.status().commanded - reference_point_;
    return {off.x(), off.y(), 0};
}

/// A path extended by the braking distance at a feed.
std::vector<Eigen::Vector3d> Runner::extended(std::vector<Eigen::Vector3d> path, double feed)
{
    const Eigen::Vector3d last = path.back() - path[path.size() - 2];
    path.push_back(path.back() + last.normalized() * braking_distance(feed));
    return path;
}

/// Reference points from the current one to the next pass.
std::vector<Eigen::Vector3d> Runner::crossing_path(const PathIndex& to) const
{
    const Eigen::Vector3d a = reference_point_, b = reference(to);
    const int pieces = std::max(1, int(std::ceil((b - a).head<2>().norm() / plan_.step)));
    // The path is a parabola through the tool point half-way: a straight line would cut into a convex surface.
    double crown = 0;
    if (pieces > 1) {
        const Eigen::Vector3d middle = path_.tool_point(path_.across_along((a + b) / 2));
        if (std::isfinite(middle.z())) crown = middle.z() - (a.z() + b.z()) / 2;
    }
    std::vector<Eigen::Vector3d> path = {a};
    for (int i = 1; i <= pieces; ++i) {
        const double s = double(i) / pieces;
        path.emplace_back(a + s * (b - a) + 4 * s * (1 - s) * crown * Eigen::Vector3d::UnitZ());
    }
    return path;
}

/// The largest force that stock of a hardness could exert on the wheel along a path of reference points, N.
double Runner::max_force(std::vector<Eigen::Vector3d> path, int layer, double feed, double hardness) const
{
    const double up = tool_point(layer).z() - reference_point_.z();
    for (Eigen::Vector3d& at : path) at.z() += up;
    return bound_.max_force(path, radius(), feed, hardness);
}

/// Predicts the force on a wheel that grinds along the passes, and is lifted from one to the next.
ForcePrediction Runner::force_on_passes(double hardness) const
{
    return [this, hardness](const std::vector<PathIndex>& points, int layer) {
        double force = 0;
        for (std::size_t first = 0, end; first < points.size(); first = end) {
            std::vector<Eigen::Vector3d> path;
            for (end = first; end < points.size() && points[end].pass == points[first].pass; ++end)
                path.push_back(reference(points[end]));
            force = std::max(force, max_force(std::move(path), layer, plan_.job.feed.rate, hardness));
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
    if (compensates_wear()) wheel_wear_ = wear_model_.loss();
    last_time_ = status.time;
    last_feed_ = feed;
    lower_stock_bound(status, feed);
    last_force_ = status.force;
    if (contact_watch_ && machine_.is_live()) contact_watch_->follow(status, feed);
}

/// Lowers the bound of the stock to the wheel's rim. Between two readings the rim may have been higher, by the
/// deflection of the peak force, and the wheel has worn.
void Runner::lower_stock_bound(const gantry::GantryStatus& status, double feed)
{
    const Eigen::Vector3d from = tip_;
    tip_ = status.commanded + (status.deflection + wear_model_.expected_loss()) * Eigen::Vector3d::UnitZ();
    const double along = (tip_ - from).head<2>().norm(), slope = along > 0 ? (tip_.z() - from.z()) / along : 0;
    if (feed > 0)
        is_climbing_ = slope > wall_slope();
    else // on a wall one layer up may not be enough
        is_climbing_ = is_climbing_ && event_ == Event::up && status.force > plan_.job.force.down;
    if (feed > 0)
        climb_ = std::max(slope, kClimbMemory * climb_);
    else if (status.force > plan_.job.force.min) // lowered onto metal, which may rise ahead
        climb_ = std::max(climb_, kAssumedSlope);
    if (!(feed > 0)) return bound_.lower(tip_, radius());
    const double reading = std::max(status.force, last_force_), above = std::max(status.peak_force - reading, 0.0);
    const Eigen::Vector3d up = above / plan_.job.force.stiffness * Eigen::Vector3d::UnitZ();
    bound_.lower(from + up, tip_ + up, radius());
}

/// Last measured radius of the wheel, mm.
double Runner::radius() const { return result_.wheel_radius > 0 ? result_.wheel_radius : plan_.job.wheel.radius; }

} // namespace fettle::strategy
