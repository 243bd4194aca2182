#include "robot/rates.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle::robot {

namespace {

std::optional<double> max_speed(const Robot& robot, std::size_t joint)
{
    if (joint < 6) return robot.dh[joint].max_speed;
    if (joint == 6) return robot.track ? robot.track->max_speed : std::nullopt;
    return robot.table ? robot.table->max_speed : std::nullopt;
}

// Mean speed of the motion to each pose; NaN where there is none.
Eigen::VectorXd mean_speeds(const FollowedPath& path, const Eigen::VectorXd& times, Eigen::Index joint)
{
    Eigen::VectorXd speed = Eigen::VectorXd::Constant(times.size(), core::kNaN);
    for (Eigen::Index i = 1; i < times.size(); ++i) {
        const double change = path.joints(joint, i) - path.joints(joint, i - 1);
        speed[i] = change == 0 ? 0 : change / (times[i] - times[i - 1]);
    }
    for (const Eigen::Index i : path.jumps) speed[i] = core::kNaN;
    return speed;
}

} // namespace

Eigen::VectorXd arrival_times(const cloud::PosePath& poses, const Feedrate& feed)
{
    return arrival_times(poses, Eigen::VectorXd::Constant(poses.size(), feed.tip_speed), feed.turn_rate);
}

Eigen::VectorXd tip_ways(const cloud::PosePath& poses)
{
    Eigen::VectorXd ways = Eigen::VectorXd::Zero(poses.size());
    for (std::size_t i = 1; i < poses.size(); ++i)
        ways[i] = (poses[i].translation() - poses[i - 1].translation()).norm();
    return ways;
}

Eigen::VectorXd arrival_times(const cloud::PosePath& poses, const Eigen::VectorXd& speeds, double turn_rate)
{
    return arrival_times(poses, tip_ways(poses), speeds, turn_rate);
}

Eigen::VectorXd arrival_times(const cloud::PosePath& poses, const Eigen::VectorXd& lengths,
                              const Eigen::VectorXd& speeds, double turn_rate)
{
    Eigen::VectorXd times = Eigen::VectorXd::Zero(poses.size());
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const double distance = lengths[i], turn = Eigen::Quaterniond(poses[i].linear())
                                                       .angularDistance(Eigen::Quaterniond(poses[i - 1].linear()));
        const double time = std::isnan(distance) ? 0 : std::max(distance / speeds[i], turn / turn_rate);
        times[i] = times[i - 1] + time;
    }
    return times;
}

std::array<JointRate, 8> joint_rates(const Robot& robot, const FollowedPath& path, const Eigen::VectorXd& times)
{
    std::array<JointRate, 8> rates;
    for (std::size_t joint = 0; joint < 8; ++joint) {
        JointRate& rate = rates[joint];
        const double limit = max_speed(robot, joint).value_or(core::kInfinity);
        const Eigen::VectorXd speed = mean_speeds(path, times, joint);
        for (Eigen::Index i = 1; i < times.size(); ++i) {
            if (std::abs(speed[i]) > limit && rate.over_limit_count++ == 0) rate.first_over_limit = i;
            if (std::abs(speed[i]) > rate.speed) {
                rate.speed = std::abs(speed[i]);
                rate.speed_at = i;
            }
            if (i + 1 == times.size()) continue;
            const double change = speed[i + 1] - speed[i];
            const double acceleration = change == 0 ? 0 : std::abs(change) / ((times[i + 1] - times[i - 1]) / 2);
            if (acceleration > rate.acceleration) {
                rate.acceleration = acceleration;
                rate.acceleration_at = i;
            }
        }
    }
    return rates;
}

} // namespace fettle::robot
