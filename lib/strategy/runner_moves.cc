// The moves of a run: along the passes, across, and over what stands between.

#include "strategy/runner.h"
#include "strategy/runner_feed.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::strategy {
namespace {

/// The side face meets no wall that takes more than this share of F_max.
constexpr double kMaxCrossingShare = 0.95;
/// It crosses fast where the stock takes no more than this share: much harder stock then stays below F_max, too.
constexpr double kMaxFastCrossingShare = 0.8;
/// A way is judged anew where the drives are farther off it than this share of a step.
constexpr double kMaxOffShare = 0.2;
constexpr int kPiecesOnWall = 2; ///< of a step there: the force is read in the middle, too
/// What is left of the steepest climb after a step: walls go on behind an edge.
constexpr double kClimbMemory = 0.85;
/// Slope that metal ahead may have where the wheel was set down on it.
constexpr double kUnknownSlope = 0.7;

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
