#include "robot/path_cloud.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "robot/arm.h"
#include "robot/body_json.h"

#include <cmath>
#include <string>

namespace fettle::robot {

namespace {

bool has_joint(const Robot& robot, Eigen::Index joint)
{
    return joint < 6 || (joint == 6 && robot.track) || (joint == 7 && robot.table);
}

std::string joint_name(Eigen::Index joint) { return "joint" + std::to_string(joint + 1); }
double joint_unit(Eigen::Index joint) { return joint == 6 ? 1 : core::kRadPerDegree; }

// Beyond these no robot file lets a joint go, and angles lose their digits.
void check_range(const Eigen::VectorXd& values, Eigen::Index joint)
{
    const double max = joint == 6 ? kMaxLength : kMaxJointDegrees;
    for (Eigen::Index i = 0; i < values.size(); ++i)
        if (std::isfinite(values[i]) && std::abs(values[i]) > max)
            throw core::InputError("point " + std::to_string(i), joint_name(joint) + " is " +
                                                                     core::to_short_text(values[i]) +
                                                                     (joint == 6 ? " mm" : " degrees") + ", at most " +
                                                                     core::to_short_text(max) + " either way");
}

} // namespace

CellJointsPath path_joints(const cloud::Cloud& cloud, const Robot& robot)
{
    CellJointsPath joints = CellJointsPath::Zero(8, cloud.size());
    for (Eigen::Index k = 0; k < 8; ++k) {
        if (!has_joint(robot, k)) continue;
        const Eigen::VectorXd values = cloud::field(cloud, joint_name(k));
        check_range(values, k);
        joints.row(k) = values * joint_unit(k);
    }
    for (auto q : joints.colwise())
        if (!q.allFinite()) q.setConstant(NAN);
    return joints;
}

void set_joints(cloud::Cloud& cloud, const Robot& robot, const CellJointsPath& joints)
{
    for (Eigen::Index k = 0; k < 8; ++k)
        if (has_joint(robot, k)) cloud::set_field(cloud, joint_name(k), joints.row(k) / joint_unit(k), 8);
}

void set_states(cloud::Cloud& cloud, const FollowedPath& path)
{
    Eigen::VectorXd states(cloud.size());
    for (Eigen::Index i = 0; i < cloud.size(); ++i) states[i] = double(path.state[i]);
    cloud::set_field(cloud, "state", states);
    cloud::set_field(cloud, "singularity", path.singularity);
}

std::optional<Eigen::VectorXd> pose_times(const cloud::Cloud& cloud)
{
    if (!cloud::has_field(cloud, "t")) return std::nullopt;
    return cloud::field(cloud, "t");
}

cloud::PosePath forward_kinematics(const Robot& robot, const CellJointsPath& joints)
{
    const Arm arm(robot);
    cloud::PosePath poses;
    for (const auto q : joints.colwise()) {
        Eigen::Isometry3d& pose = poses.emplace_back(Eigen::Isometry3d::Identity());
        if (q.hasNaN()) {
            pose.translation().setConstant(NAN);
            continue;
        }
        pose = part_in_cell(robot, q[7]).inverse() * base_in_cell(robot, q[6]) * arm.flange(q.head<6>()) *
               robot.T_flange_tool;
    }
    return poses;
}

} // namespace fettle::robot
