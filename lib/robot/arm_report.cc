#include "robot/arm_report.h"

#include "core/constants.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::robot {

namespace {

using json::Value;

std::size_t count_of(const FollowedPath& path, PoseState state)
{
    return static_cast<std::size_t>(std::count(path.state.begin(), path.state.end(), state));
}

// The index of a pose; null if there is none.
Value index_or_null(Eigen::Index index) { return index < 0 ? Value(NAN) : Value(index); }

Value joint_to_json(const FollowedPath& path, Eigen::Index joint, double unit, const JointRate* rate)
{
    Value value;
    double min = INFINITY, max = -INFINITY;
    for (Eigen::Index i = 0; i < path.joints.cols(); ++i) {
        min = std::fmin(min, path.joints(joint, i)); // ignores NaN
        max = std::fmax(max, path.joints(joint, i));
    }
    value.set("joint", static_cast<int>(joint) + 1)
        .set("min", min / unit)
        .set("max", max / unit)
        .set("out_of_range", path.out_of_range_counts[joint]);
    if (rate == nullptr) return value;
    value.set("max_speed", rate->speed / unit)
        .set("max_speed_at", index_or_null(rate->speed_at))
        .set("max_acceleration", rate->acceleration / unit)
        .set("max_acceleration_at", index_or_null(rate->acceleration_at))
        .set("too_fast", rate->over_limit_count);
    return value;
}

Value to_json(const AxisRule& rule, double unit)
{
    return Value().set("follows", rule.follows).set("value", rule.value / unit);
}

/// What keeps a robot from running a path, at a pose of it.
struct Obstacle {
    Eigen::Index pose;
    std::string reason;
};

std::string joint_text(Eigen::Index joint) { return "joint " + std::to_string(joint + 1); }

double unit_of_joint(Eigen::Index joint) { return joint == 6 ? 1 : core::kRadPerDegree; }
std::string unit_text(Eigen::Index joint) { return joint == 6 ? " mm" : " degrees"; }
std::string value_text(Eigen::Index joint, double value) { return core::to_short_text(value / unit_of_joint(joint)); }

JointRange range_of(const Robot& robot, Eigen::Index joint)
{
    if (joint < 6) return robot.dh[joint].range;
    return joint == 6 ? robot.track->range : robot.table->range;
}

std::optional<Obstacle> first_unreached(const Robot& robot, const FollowedPath& path)
{
    for (std::size_t i = 0; i < path.state.size(); ++i) {
        const auto pose = static_cast<Eigen::Index>(i);
        const double value = path.obstacle_value[pose];
        const Eigen::Index joint = path.joint_out_of_range[i];
        switch (path.state[i]) {
        case PoseState::reached:
            break;
        case PoseState::unreachable:
            return Obstacle{pose, "is out of the arm's reach: the flange would be " + core::to_short_text(value) +
                                      " mm from the base"};
        case PoseState::out_of_range: {
            const JointRange range = range_of(robot, joint);
            return Obstacle{pose, joint_text(joint) + " would be at " + value_text(joint, value) + unit_text(joint) +
                                      ", out of its range of " + value_text(joint, range.min) + " to " +
                                      value_text(joint, range.max)};
        }
        case PoseState::undefined:
            return Obstacle{pose, "is not defined"};
        }
    }
    return std::nullopt;
}

std::optional<Obstacle> first_jump(const FollowedPath& path)
{
    if (path.jumps.empty()) return std::nullopt;
    const Eigen::Index pose = path.jumps.front();
    CellJoints turn = (path.joints.col(pose) - path.joints.col(pose - 1)).cwiseAbs();
    turn[6] = 0; // a track does not jump
    Eigen::Index joint = 0;
    const double max = turn.maxCoeff(&joint);
    return Obstacle{pose, joint_text(joint) + " jumps by " + value_text(joint, max) + " degrees, from " +
                              value_text(joint, path.joints(joint, pose - 1)) + " to " +
                              value_text(joint, path.joints(joint, pose))};
}

std::optional<Obstacle> first_too_fast(const Robot& robot, const FollowedPath& path, const Eigen::VectorXd& times)
{
    std::optional<Obstacle> first;
    const std::array<JointRate, 8> rates = joint_rates(robot, path, times);
    for (Eigen::Index joint = 0; joint < 8; ++joint) {
        const Eigen::Index pose = rates[joint].first_over_limit;
        if (pose < 0 || (first && pose >= first->pose)) continue;
        const double speed =
            std::abs(path.joints(joint, pose) - path.joints(joint, pose - 1)) / (times[pose] - times[pose - 1]);
        first = {pose, joint_text(joint) + " is too fast on the way to it: " + value_text(joint, speed) +
                           unit_text(joint) + "/s"};
    }
    return first;
}

} // namespace

std::string path_obstacle(const Robot& robot, const FollowedPath& path, const std::optional<Eigen::VectorXd>& times)
{
    std::optional<Obstacle> first;
    for (const std::optional<Obstacle>& found :
         {first_unreached(robot, path), first_jump(path), times ? first_too_fast(robot, path, *times) : std::nullopt})
        if (found && (!first || found->pose < first->pose)) first = found;
    return first ? "pose " + std::to_string(first->pose) + ": " + first->reason : "";
}

void add_report(Value& report, const Robot& robot, const ExternalChoice& externals, const units::Units& units)
{
    if (robot.track) report.set("track", to_json(externals.track, units.mm()));
    if (robot.table) report.set("table", to_json(externals.table, core::kRadPerDegree));
}

bool add_report(Value& report, const Robot& robot, const FollowedPath& path, double singularity_threshold,
                const std::optional<Eigen::VectorXd>& times, const units::Units& units)
{
    Eigen::Index nearest = -1;
    std::size_t near_count = 0;
    for (Eigen::Index i = 0; i < path.singularity.size(); ++i) {
        if (std::isnan(path.singularity[i])) continue;
        if (path.singularity[i] < singularity_threshold) ++near_count;
        if (nearest < 0 || path.singularity[i] < path.singularity[nearest]) nearest = i;
    }
    std::vector<Value> jumps;
    for (const Eigen::Index i : path.jumps) jumps.emplace_back(static_cast<std::size_t>(i));
    report.set("count", path.state.size())
        .set("reached", count_of(path, PoseState::reached))
        .set("unreachable", count_of(path, PoseState::unreachable))
        .set("out_of_range", count_of(path, PoseState::out_of_range))
        .set("undefined", count_of(path, PoseState::undefined))
        .set("jumps", jumps)
        .set("singular", near_count)
        .set("min_singularity", nearest < 0 ? NAN : path.singularity[nearest])
        .set("min_singularity_at", index_or_null(nearest));
    std::array<JointRate, 8> rates;
    if (times) rates = joint_rates(robot, path, *times);
    if (times && times->size() > 0) report.set("time", (*times)[times->size() - 1] - (*times)[0]);
    bool slow_enough = true;
    std::vector<Value> joints;
    for (Eigen::Index k = 0; k < 8; ++k) {
        if ((k == 6 && !robot.track) || (k == 7 && !robot.table)) continue;
        const double unit = k == 6 ? units.mm() : std::numbers::pi / 180;
        const JointRate& rate = rates[k];
        joints.push_back(joint_to_json(path, k, unit, times ? &rate : nullptr));
        slow_enough = slow_enough && rate.over_limit_count == 0;
    }
    report.set("joints", joints);
    return slow_enough && path.jumps.empty() && count_of(path, PoseState::reached) == path.state.size();
}

} // namespace fettle::robot
