#include "robot/path_cloud.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "robot/arm.h"

#include <cmath>

namespace fettle {

namespace {

bool has_joint(const Robot& robot, Eigen::Index joint)
{
    return joint < 6 || (joint == 6 && robot.track) || (joint == 7 && robot.table);
}

std::string joint_name(Eigen::Index joint) { return "joint" + std::to_string(joint + 1); }
double joint_unit(Eigen::Index joint) { return joint == 6 ? 1 : kRadPerDegree; }

} // namespace

CellJointsPath path_joints(const Cloud& cloud, const Robot& robot)
{
    CellJointsPath joints = CellJointsPath::Zero(8, cloud.size());
    for (Eigen::Index k = 0; k < 8; ++k)
        if (has_joint(robot, k)) joints.row(k) = field(cloud, joint_name(k)) * joint_unit(k);
    for (auto q : joints.colwise())
        if (!q.allFinite()) q.setConstant(NAN);
    return joints;
}

void set_joints(Cloud& cloud, const Robot& robot, const CellJointsPath& joints)
{
    for (Eigen::Index k = 0; k < 8; ++k)
        if (has_joint(robot, k)) set_field(cloud, joint_name(k), joints.row(k) / joint_unit(k), 8);
}

void set_states(Cloud& cloud, const FollowedPath& path)
{
    Eigen::VectorXd states(cloud.size());
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        states[i] = static_cast<double>(path.state[static_cast<std::size_t>(i)]);
    set_field(cloud, "state", states);
    set_field(cloud, "singularity", path.singularity);
}

PosePath forward(const Robot& robot, const CellJointsPath& joints)
{
    const Arm arm(robot);
    PosePath poses;
    for (const auto q : joints.colwise()) {
        Eigen::Isometry3d& pose = poses.emplace_back(Eigen::Isometry3d::Identity());
        if (q.hasNaN()) {
            pose.translation().setConstant(NAN);
            continue;
        }
        pose =
            cell_part(robot, q[7]).inverse() * cell_base(robot, q[6]) * arm.flange(q.head<6>()) * robot.T_flange_tool;
    }
    return poses;
}

} // namespace fettle
