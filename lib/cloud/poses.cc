#include "cloud/poses.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fettle::cloud {

PosePath read_poses(const Cloud& cloud)
{
    Eigen::Matrix4Xd q(4, cloud.size());
    for (Eigen::Index k = 0; k < 4; ++k) q.row(k) = field(cloud, kQuaternion[k]);
    PosePath poses(cloud.size());
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        Eigen::Isometry3d& pose = poses[i];
        pose.setIdentity();
        pose.translation() = cloud.xyz.col(i);
        const double norm = q.col(i).stableNorm();
        if (norm == 0) throw core::InputError("point " + std::to_string(i) + ": the quaternion qw qx qy qz is 0");
        if (!std::isfinite(norm) || !cloud.xyz.col(i).allFinite()) {
            pose.translation().setConstant(NAN);
            continue;
        }
        const Eigen::Vector4d unit = q.col(i) / norm;
        pose.linear() = Eigen::Quaterniond(unit[0], unit[1], unit[2], unit[3]).toRotationMatrix();
    }
    return poses;
}

void set_poses(Cloud& cloud, const PosePath& poses)
{
    Eigen::Matrix4Xd q(4, cloud.size());
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        const Eigen::Isometry3d& pose = poses[i];
        cloud.xyz.col(i) = pose.translation();
        const Eigen::Quaterniond rotation(pose.linear());
        const double sign = rotation.w() < 0 ? -1 : 1; // q and -q are the same rotation
        q.col(i) << sign * rotation.w(), sign * rotation.x(), sign * rotation.y(), sign * rotation.z();
        if (pose.translation().hasNaN()) q.col(i).setConstant(NAN);
    }
    for (Eigen::Index k = 0; k < 4; ++k) set_field(cloud, kQuaternion[k], q.row(k), 8);
}

Eigen::VectorXd read_strokes(const Cloud& cloud)
{
    for (const char* name : {"stroke", "pass"})
        if (has_field(cloud, name)) return field(cloud, name);
    return Eigen::VectorXd::Zero(cloud.size());
}

std::vector<Motion> read_motions(const Cloud& cloud)
{
    std::vector<Motion> motions(cloud.size(), Motion::stroke);
    const bool is_given = has_field(cloud, "motion");
    const Eigen::VectorXd values = is_given ? field(cloud, "motion") : read_strokes(cloud);
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        if (is_given && !(values[i] == 0 || values[i] == 1 || values[i] == 2 || values[i] == 3))
            throw core::InputError("point " + std::to_string(i) + ": motion is " + core::to_short_text(values[i]) +
                                   ", expected 0 to 3");
        if (is_given)
            motions[i] = static_cast<Motion>(static_cast<int>(values[i]));
        else if (values[i] < 0)
            motions[i] = Motion::travel;
    }
    return motions;
}

Eigen::Isometry3d parse_pose(const std::string& text)
{
    const Eigen::VectorXd numbers = core::parse_number_list(text);
    if (numbers.size() != 7 || !numbers.allFinite() || !(numbers.tail<4>().norm() > 0))
        throw core::InputError("expected x,y,z,qw,qx,qy,qz, got " + core::in_quotes(text));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = numbers.head<3>();
    pose.linear() = Eigen::Quaterniond(numbers[3], numbers[4], numbers[5], numbers[6]).normalized().toRotationMatrix();
    return pose;
}

} // namespace fettle::cloud
