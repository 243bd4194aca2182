#include "robot/rates.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle {

namespace {

std::optional<double> max_speed(const Robot& robot, std::size_t joint)
{
    if (joint < 6) return robot.dh[joint].max_speed;
    if (joint == 6) return robot.track ? robot.track->max_speed : std::nullopt;
    return robot.table ? robot.table->max_speed : std::nullopt;
}

// Mean speed on the way to each pose; NaN where there is none.
Eigen::VectorXd speeds(const FollowedPath& path, const Eigen::VectorXd& times, Eigen::Index joint)
{
    Eigen::VectorXd speed = Eigen::VectorXd::Constant(times.size(), std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index i = 1; i < times.size(); ++i) {
        const double way = path.joints(joint, i) - path.joints(joint, i - 1);
        speed[i] = way == 0 ? 0 : way / (times[i] - times[i - 1]);
    }
    for (const Eigen::Index i : path.jumps) speed[i] = std::numeric_limits<double>::quiet_NaN();
    return speed;
}

} // namespace

Eigen::VectorXd arrival_times(const PosePath& poses, const Feedrate& feed)
{
    Eigen::VectorXd times = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(poses.size()));
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const double way = (poses[i].translation() - poses[i - 1].translation()).norm();
        const double turn =
            Eigen::Quaterniond(poses[i].linear()).angularDistance(Eigen::Quaterniond(poses[i - 1].linear()));
        const double time = std::isnan(way) ? 0 : std::max(way / feed.tip, turn / feed.turn);
        times[static_cast<Eigen::Index>(i)] = times[static_cast<Eigen::Index>(i) - 1] + time;
    }
    return times;
}

std::array<JointRate, 8> joint_rates(const Robot& robot, const FollowedPath& path, const Eigen::VectorXd& times)
{
    std::array<JointRate, 8> rates;
    for (std::size_t joint = 0; joint < 8; ++joint) {
        JointRate& rate = rates[joint];
        const double most = max_speed(robot, joint).value_or(std::numeric_limits<double>::infinity());
        const Eigen::VectorXd speed = speeds(path, times, static_cast<Eigen::Index>(joint));
        for (Eigen::Index i = 1; i < times.size(); ++i) {
            if (std::abs(speed[i]) > most) ++rate.too_fast;
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

} // namespace fettle
