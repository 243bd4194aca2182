#include "robot/arm_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle {

namespace {

using json::Value;

std::size_t count_of(const FollowedPath& path, PoseState state)
{
    return static_cast<std::size_t>(std::count(path.state.begin(), path.state.end(), state));
}

Value place(Eigen::Index index) { return index < 0 ? Value(NAN) : Value(static_cast<std::size_t>(index)); }

Value joint_to_json(const FollowedPath& path, Eigen::Index joint, double unit, const JointRate* rate)
{
    Value value;
    double least = INFINITY, most = -INFINITY;
    for (Eigen::Index i = 0; i < path.joints.cols(); ++i) {
        least = std::fmin(least, path.joints(joint, i)); // passes NaN over
        most = std::fmax(most, path.joints(joint, i));
    }
    value.set("joint", static_cast<int>(joint) + 1)
        .set("min", least / unit)
        .set("max", most / unit)
        .set("out_of_range", static_cast<std::size_t>(path.blocked[joint]));
    if (rate == nullptr) return value;
    value.set("max_speed", rate->speed / unit)
        .set("max_speed_at", place(rate->speed_at))
        .set("max_acceleration", rate->acceleration / unit)
        .set("max_acceleration_at", place(rate->acceleration_at))
        .set("too_fast", static_cast<std::size_t>(rate->too_fast));
    return value;
}

} // namespace

Value to_json(const AxisRule& rule, double unit)
{
    return Value().set("follows", rule.follows).set("value", rule.value / unit);
}

bool add_report(Value& report, const Robot& robot, const FollowedPath& path, double singular,
                const std::optional<Eigen::VectorXd>& times, const Units& units)
{
    Eigen::Index nearest = -1;
    std::size_t near = 0;
    for (Eigen::Index i = 0; i < path.singularity.size(); ++i) {
        if (std::isnan(path.singularity[i])) continue;
        if (path.singularity[i] < singular) ++near;
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
        .set("singular", near)
        .set("least_singularity", nearest < 0 ? NAN : path.singularity[nearest])
        .set("least_singularity_at", place(nearest));
    std::array<JointRate, 8> rates;
    if (times) rates = joint_rates(robot, path, *times);
    if (times && times->size() > 0) report.set("time", (*times)[times->size() - 1] - (*times)[0]);
    bool slow_enough = true;
    std::vector<Value> joints;
    for (Eigen::Index k = 0; k < 8; ++k) {
        if ((k == 6 && !robot.track) || (k == 7 && !robot.table)) continue;
        const double unit = k == 6 ? units.mm() : std::numbers::pi / 180;
        const JointRate& rate = rates[static_cast<std::size_t>(k)];
        joints.push_back(joint_to_json(path, k, unit, times ? &rate : nullptr));
        slow_enough = slow_enough && rate.too_fast == 0;
    }
    report.set("joints", joints);
    return slow_enough && path.jumps.empty() && count_of(path, PoseState::reached) == path.state.size();
}

} // namespace fettle
