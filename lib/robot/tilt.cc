#include "robot/tilt.h"

#include <cmath>

namespace fettle {

namespace {

// A sphere this near to it is a ball end, mm: robot files are written with so many digits.
constexpr double kSameLength = 1e-6;

bool on_axis_above_tip(const Eigen::Vector3d& centre, double radius)
{
    return (centre - Eigen::Vector3d(0, 0, radius)).norm() <= kSameLength;
}

Eigen::Quaterniond turn_of(const Eigen::Vector2d& tilt)
{
    const double angle = tilt.norm();
    if (angle == 0) return Eigen::Quaterniond::Identity();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d(tilt.x() / angle, tilt.y() / angle, 0)));
}

} // namespace

double tilt_pivot(const Robot& robot)
{
    for (const Body& body : robot.bodies) {
        if (body.link != link::kTool) continue;
        if (const auto* ball = std::get_if<solid::Sphere>(&body.solid))
            if (on_axis_above_tip(ball->centre, ball->radius)) return ball->radius;
        if (const auto* round = std::get_if<solid::Capsule>(&body.solid))
            if (on_axis_above_tip(round->from, round->radius) || on_axis_above_tip(round->to, round->radius))
                return round->radius;
    }
    return 0;
}

Eigen::Isometry3d changed_pose(const Eigen::Isometry3d& T_part_tool, const PoseChange& change, double pivot,
                               const Eigen::Vector3d& away)
{
    const Eigen::Translation3d to_pivot(0, 0, pivot);
    Eigen::Isometry3d T = T_part_tool;
    if (!change.tilt.isZero(0)) T = T * to_pivot * turn_of(change.tilt) * to_pivot.inverse();
    T.translation() += change.retreat * away;
    return T;
}

double tilt_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
    return turn_of(a).angularDistance(turn_of(b));
}

} // namespace fettle
