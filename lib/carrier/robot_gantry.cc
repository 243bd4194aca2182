#include "carrier/robot_gantry.h"

#include "carrier/work_points.h"
#include "robot/path_cloud.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::carrier {
namespace {

using cloud::Motion;
using gantry::GantryFault;
using gantry::GantryStatus;

/// Between two poses at which the inverse kinematics are solved, mm: the joints, moving evenly, keep the tip within
/// some micrometres of the straight line.
constexpr double kStep = 1;
/// Highest speed of the tip, mm/s: that of a robot beside which somebody may stand (ISO 10218-1, reduced speed).
constexpr double kMaxTipSpeed = 250;
/// What is no faster than a joint's limit must not seem so after rounding.
constexpr double kSpeedMargin = 1e-9;

} // namespace

RobotGantry::RobotGantry(const robot::Robot& robot, const robot::PathArguments& arguments, const plan::Plan& plan,
                         std::unique_ptr<gantry::VirtualGantry> head)
    : robot_(robot), arguments_(arguments), plan_(plan), head_(std::move(head))
{
    robot::check_arguments(robot, arguments, 1);
}

void RobotGantry::set_frame(const Eigen::Isometry3d& T_cell_job)
{
    if (arm_) throw GantryFault("the frame of the job is set once");
    const double top = head_->stock().z.maxCoeff<Eigen::PropagateNumbers>();
    arm_.emplace(robot_, arguments_, T_cell_job, plan_.job.theta, work_points(plan_, at(), top));
    joints_ = arm_->start();
    recorded_ = at();
    moments_.push_back({status().time, arm_->pose_at(at()), joints_, Motion::travel});
}

const ArmFollower& RobotGantry::arm_or_fault() const
{
    if (!arm_)
        throw GantryFault("the robot does not know where the job lies: no frame was given (fettle-grind --place)");
    return *arm_;
}

GantryStatus RobotGantry::status() const
{
    arm_or_fault();
    GantryStatus status = head_->status();
    status.time += delay_;
    return status;
}

gantry::protocol::Limits RobotGantry::limits() const
{
    gantry::protocol::Limits limits = head_->limits();
    limits.speed = std::min(limits.speed, kMaxTipSpeed);
    return limits;
}

/// Up to a height, across, and down.
std::vector<RobotGantry::Leg> RobotGantry::way_over(const Eigen::Vector3d& tool_point, double height) const
{
    const double z = std::max(height, at().z());
    return {{{at().x(), at().y(), z}, Motion::approach},
            {{tool_point.x(), tool_point.y(), z}, Motion::travel},
            {tool_point, Motion::approach}};
}

std::vector<RobotGantry::Leg> RobotGantry::way_up() const
{
    return {{{at().x(), at().y(), std::max(safe_height(), at().z())}, Motion::approach}};
}

/// @throws GantryFault for the first place on the way that the arm does not reach
std::vector<RobotGantry::Step> RobotGantry::steps_of(const std::vector<Leg>& legs) const
{
    const ArmFollower& arm = arm_or_fault();
    std::vector<Step> steps;
    Eigen::Vector3d from = recorded_;
    robot::CellJoints joints = joints_;
    for (const Leg& leg : legs) {
        const double length = (leg.to - from).norm();
        const int count = static_cast<int>(std::ceil(length / kStep));
        for (int i = 1; i <= count; ++i) {
            const Eigen::Vector3d point = from + (leg.to - from) * (static_cast<double>(i) / count);
            const robot::CellJoints before = std::exchange(joints, arm.joints_at(point, joints));
            steps.push_back(
                {point, joints, length / count, arm.min_duration(before, joints) * (1 + kSpeedMargin), leg.motion});
        }
        from = leg.to;
    }
    return steps;
}

/// Lets the head make a move that follows the legs, or ends early above the end of the last one.
template <class Move>
void RobotGantry::carry(const std::vector<Leg>& legs, const Move& move)
{
    std::vector<Step> steps = steps_of(legs); // nothing moves on a way that is not reached
    const double begin = status().time;
    const auto follow = [&] { record(steps, begin, head_->status().time + delay_ - begin); };
    head_->set_interrupt([this](const GantryStatus& /*now*/) { return is_interrupted(); });
    try {
        move();
    } catch (...) { // whatever ended the move: where the arm came to is recorded, and the caller learns why
        steps = steps_of({{at(), legs.back().motion}});
        follow();
        throw;
    }
    if (at() != legs.back().to) {
        std::vector<Leg> made = legs;
        made.back().to = at();
        steps = steps_of(made);
    }
    follow();
}

/// Appends a way that took the head `duration`. Where the joints are slower the clock goes on.
void RobotGantry::record(const std::vector<Step>& steps, double begin, double duration)
{
    double length = 0;
    for (const Step& step : steps) length += step.length;
    double time = begin;
    for (const Step& step : steps) {
        const double of_head = duration * step.length / length;
        delay_ += std::max(0.0, step.min_duration - of_head);
        time += std::max(of_head, step.min_duration);
        moments_.push_back({time, arm_->pose_at(step.at), step.joints, step.motion});
    }
    if (steps.empty()) return;
    joints_ = steps.back().joints;
    recorded_ = steps.back().at;
}

GantryStatus RobotGantry::travel(const Eigen::Vector3d& tool_point)
{
    carry(way_over(tool_point, safe_height()), [&] { head_->travel(tool_point); });
    return status();
}

GantryStatus RobotGantry::travel_low(const Eigen::Vector3d& tool_point, double over, double free)
{
    carry(way_over(tool_point, over), [&] { head_->travel_low(tool_point, over, free); });
    return status();
}

/// A feed at which a joint would be too fast is lowered, as a robot's controller does.
GantryStatus RobotGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    const std::vector<Leg> legs = {{tool_point, Motion::stroke}};
    double possible = feed;
    for (const Step& step : steps_of(legs))
        if (step.min_duration > 0) possible = std::min(possible, step.length / step.min_duration);
    carry(legs, [&] { head_->grind(tool_point, possible); });
    return status();
}

GantryStatus RobotGantry::lift(double commanded_z)
{
    carry({{{at().x(), at().y(), commanded_z}, Motion::approach}}, [&] { head_->lift(commanded_z); });
    return status();
}

double RobotGantry::touch_off()
{
    double radius = 0;
    carry(way_up(), [&] { radius = head_->touch_off(); });
    return radius;
}

void RobotGantry::change_wheel()
{
    carry(way_up(), [&] { head_->change_wheel(); });
}

double RobotGantry::probe(const Eigen::Vector2d& xy, double lowest)
{
    // Down to where the tip could go, and back up.
    steps_of(way_over({xy.x(), xy.y(), lowest}, safe_height()));
    double z = 0;
    carry(way_over({xy.x(), xy.y(), safe_height()}, safe_height()), [&] { z = head_->probe(xy, lowest); });
    return z;
}

void RobotGantry::turn_to(double theta) { head_->turn_to(theta); }

cloud::Cloud to_cloud(const robot::Robot& robot, const std::vector<RobotGantry::Moment>& moments)
{
    const auto count = static_cast<Eigen::Index>(moments.size());
    cloud::PosePath poses;
    robot::CellJointsPath joints(8, count);
    Eigen::VectorXd times(count), motions(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const RobotGantry::Moment& moment = moments[i];
        poses.push_back(moment.pose);
        joints.col(i) = moment.joints;
        times[i] = moment.time;
        motions[i] = static_cast<double>(moment.motion);
    }
    cloud::Cloud cloud;
    cloud.xyz.resize(3, count);
    cloud.comment = "frame: cell";
    cloud::set_poses(cloud, poses);
    robot::set_joints(cloud, robot, joints);
    cloud::set_field(cloud, "t", times, 8);
    cloud::set_field(cloud, "motion", motions);
    return cloud;
}

} // namespace fettle::carrier
