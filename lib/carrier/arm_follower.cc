#include "carrier/arm_follower.h"

#include "core/constants.h"
#include "core/text.h"
#include "gantry/gantry.h"
#include "job/job.h"
#include "robot/arm_report.h"
#include "robot/collision.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::carrier {
namespace {

using gantry::GantryFault;

constexpr double kTurn = 2 * std::numbers::pi;
const std::string kAuto = robot::PathArguments().track; // its place is to be chosen
constexpr Eigen::Index kTrack = 6, kTable = 7;          // in robot::CellJoints

/// A place to the micrometre.
std::string pose_text(const Eigen::Vector3d& place)
{
    std::string text = "the pose at ";
    for (const double coordinate : place) text += core::to_short_text(std::round(coordinate * 1000) / 1000 + 0.0) + " ";
    return text + "mm";
}

std::string value_text(Eigen::Index joint, double value)
{
    return core::to_short_text(joint == kTrack ? value : value / core::kRadPerDegree);
}

std::string joint_text(Eigen::Index joint) { return "joint " + std::to_string(joint + 1); }

/// What robot::path_obstacle() says of the first pose that is not reached, with the place for its number.
std::string obstacle_at(const robot::Robot& robot, robot::FollowedPath path, const std::vector<Eigen::Vector3d>& points)
{
    path.jumps.clear();
    const auto unreached =
        std::ranges::find_if_not(path.state, [](robot::PoseState state) { return state == robot::PoseState::reached; });
    if (unreached == path.state.end()) return "";
    const std::string text = robot::path_obstacle(robot, path, std::nullopt), reason = text.substr(text.find(": ") + 2);
    return pose_text(points[unreached - path.state.begin()]) + (reason.starts_with("is ") ? " " : ": ") + reason;
}

/// The solution of the inverse that is nearest to `from`, each joint by whole turns; nothing if there is none.
std::optional<robot::Joints> nearest_solution(const robot::ArmSolutions& solutions, const robot::Joints& from)
{
    std::optional<robot::Joints> nearest;
    double min_distance = core::kInfinity;
    for (const robot::ArmSolution& solution : solutions) {
        const robot::Joints turns = ((from - solution.joints) / kTurn).array().round();
        const robot::Joints joints = solution.joints + kTurn * turns;
        const double distance = (joints - from).squaredNorm();
        if (distance >= min_distance) continue;
        min_distance = distance;
        nearest = joints;
    }
    return nearest;
}

} // namespace

ArmFollower::ArmFollower(const robot::Robot& robot, const robot::PathArguments& arguments,
                         const Eigen::Isometry3d& T_cell_job, double theta, const std::vector<Eigen::Vector3d>& points)
    : robot_(robot), arm_(robot), T_cell_job_(T_cell_job),
      jump_threshold_(arguments.jump_threshold_deg * core::kRadPerDegree)
{
    // The wheel turns about X_w; a tool's wheel about its y, as in plan::pose_path().
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(theta).transpose();
    R_job_tool_.setIdentity();
    R_job_tool_.col(0).head<2>() = R_machine_working.col(1);
    R_job_tool_.col(1) = R_job_tool_.col(2).cross(R_job_tool_.col(0));
    choose(arguments, points);
    robot::CellJointsPath joints(8, static_cast<Eigen::Index>(points.size()));
    for (Eigen::Index i = 0; i < joints.cols(); ++i)
        joints.col(i) = joints_at(points[i], i > 0 ? robot::CellJoints(joints.col(i - 1)) : start_);
    check_clearance(joints, points);
}

void ArmFollower::choose(const robot::PathArguments& arguments, const std::vector<Eigen::Vector3d>& points)
{
    cloud::PosePath poses;
    for (const Eigen::Vector3d& point : points) poses.push_back(pose_at(point));
    cloud::Cloud cloud;
    cloud.xyz.resize(3, static_cast<Eigen::Index>(poses.size()));
    cloud::set_poses(cloud, poses);
    const robot::SolvedPath solved = robot::path_from_poses(robot_, cloud, arguments, 1);
    if (const std::string obstacle = obstacle_at(robot_, solved.path, points); !obstacle.empty())
        throw GantryFault(robot_.track && arguments.track == kAuto
                              ? obstacle_abreast(arguments, cloud, points, solved.external_values(1, 0))
                              : obstacle);
    externals_ = solved.externals;
    if (externals_.table.follows)
        throw GantryFault("the table would turn while the wheel grinds: it has to stand still (--table DEG)");
    start_ = solved.path.joints.col(0);
}

/// The obstacle with the track abreast of the work: where no place of it will do, the one that was chosen tells
/// nothing.
std::string ArmFollower::obstacle_abreast(robot::PathArguments arguments, const cloud::Cloud& poses,
                                          const std::vector<Eigen::Vector3d>& points, double table) const
{
    const Eigen::Vector3d middle = robot::part_in_cell(robot_, table) * Eigen::Vector3d(poses.xyz.rowwise().mean());
    const Eigen::Vector3d from_base = middle - robot_.T_cell_base.translation();
    const robot::JointRange& range = robot_.track->range;
    const std::string abreast =
        core::to_short_text(std::clamp(from_base.dot(robot_.track->axis), range.min, range.max));
    arguments.track = abreast;
    const robot::SolvedPath solved = robot::path_from_poses(robot_, poses, arguments, 1);
    const std::string obstacle = obstacle_at(robot_, solved.path, points);
    return (obstacle.empty() ? "the job is not reached as a whole" : obstacle) + ", with the track at " + abreast +
           " mm; from no other place of it all of the job is reached";
}

Eigen::Isometry3d ArmFollower::pose_at(const Eigen::Vector3d& tool_point) const
{
    Eigen::Isometry3d T_job_tool = Eigen::Isometry3d::Identity();
    T_job_tool.linear() = R_job_tool_;
    T_job_tool.translation() = tool_point;
    return T_cell_job_ * T_job_tool;
}

robot::CellJoints ArmFollower::joints_at(const Eigen::Vector3d& tool_point, const robot::CellJoints& from) const
{
    const Eigen::Isometry3d pose = pose_at(tool_point);
    const Eigen::Vector2d external = robot::external_values(robot_, {pose}, externals_.track, externals_.table).col(0);
    const Eigen::Isometry3d flange = robot::flange_target(robot_, pose, external[0], external[1]);
    const robot::Joints before = from.head<6>();
    const auto arm = nearest_solution(arm_.solve(flange, before, robot::Ranges::ignore), before);
    if (!arm)
        throw GantryFault(pose_text(tool_point) + " is out of the arm's reach: the flange would be " +
                          core::to_short_text(flange.translation().norm()) + " mm from the base");
    robot::CellJoints joints;
    joints << *arm, external;
    for (Eigen::Index k = 0; k < 8; ++k) check_range(tool_point, k, joints[k]);
    Eigen::Index joint = 0;
    if (const double turn = (*arm - before).cwiseAbs().maxCoeff(&joint); turn > jump_threshold_)
        throw GantryFault(pose_text(tool_point) + ": " + joint_text(joint) + " would jump by " +
                          value_text(joint, turn) + " degrees, from " + value_text(joint, before[joint]) + " to " +
                          value_text(joint, joints[joint]));
    return joints;
}

/// Arm, tool and fixtures among each other. Where metal stands the strategy finds out.
void ArmFollower::check_clearance(const robot::CellJointsPath& joints, const std::vector<Eigen::Vector3d>& points) const
{
    robot::CollisionOptions options;
    options.max_clearance = 1; // mm: how far apart bodies are is not asked
    const robot::CheckedPath checked = robot::check_path(robot_, nullptr, joints, options);
    const std::vector<robot::CellPair> pairs = robot::checked_pairs(robot_);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const robot::CellClearance& found : {checked.between_poses[i], checked.at_poses[i]})
            if (found.clearance < -options.tolerance)
                throw GantryFault(pose_text(points[i]) + ": " + robot::body_name(robot_, pairs[found.pair].a) +
                                  " and " + robot::body_name(robot_, pairs[found.pair].b) + " would collide, " +
                                  core::to_short_text(-found.clearance) + " mm deep");
}

void ArmFollower::check_range(const Eigen::Vector3d& tool_point, Eigen::Index joint, double value) const
{
    if ((joint == kTrack && !robot_.track) || (joint == kTable && !robot_.table)) return;
    const robot::JointRange& range = joint == kTrack   ? robot_.track->range
                                     : joint == kTable ? robot_.table->range
                                                       : robot_.dh[joint].range;
    if (range.contains(value)) return;
    throw GantryFault(pose_text(tool_point) + ": " + joint_text(joint) + " would be at " + value_text(joint, value) +
                      (joint == kTrack ? " mm" : " degrees") + ", out of its range of " + value_text(joint, range.min) +
                      " to " + value_text(joint, range.max));
}

double ArmFollower::min_duration(const robot::CellJoints& from, const robot::CellJoints& to) const
{
    double duration = 0;
    const auto add = [&](Eigen::Index k, const std::optional<double>& max_speed) {
        if (max_speed) duration = std::max(duration, std::abs(to[k] - from[k]) / *max_speed);
    };
    for (Eigen::Index k = 0; k < 6; ++k) add(k, robot_.dh[k].max_speed);
    if (robot_.track) add(kTrack, robot_.track->max_speed);
    return duration;
}

} // namespace fettle::carrier
