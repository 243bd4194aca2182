#include "robot/tilt.h"

namespace fettle::robot {

namespace {

// Tolerance of the position of a ball end, mm: robot files are written with that many digits.
constexpr double kLengthTolerance = 1e-6;

bool touches_tip(const Eigen::Vector3d& centre, double radius)
{
    return (centre - Eigen::Vector3d(0, 0, radius)).norm() <= kLengthTolerance;
}

Eigen::Quaterniond tilt_rotation(const Eigen::Vector2d& tilt)
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
            if (touches_tip(ball->centre, ball->radius)) return ball->radius;
        if (const auto* round = std::get_if<solid::Capsule>(&body.solid))
            if (touches_tip(round->from, round->radius) || touches_tip(round->to, round->radius)) return round->radius;
    }
    return 0;
}

Eigen::Isometry3d changed_pose(const Eigen::Isometry3d& T_part_tool, const PoseChange& change, double pivot,
                               const Eigen::Vector3d& retreat_direction)
{
    const Eigen::Translation3d to_pivot(0, 0, pivot);
    Eigen::Isometry3d T = T_part_tool;
    if (!change.tilt.isZero(0)) T = T * to_pivot * tilt_rotation(change.tilt) * to_pivot.inverse();
    T.translation() += change.retreat * retreat_direction;
    return T;
}

double tilt_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
    return tilt_rotation(a).angularDistance(tilt_rotation(b));
}

} // namespace fettle::robot
