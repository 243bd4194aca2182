#include "cloud/poses.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace fettle {

namespace {

const char* const kQuaternion[] = {"qw", "qx", "qy", "qz"};

} // namespace

bool has_poses(const Cloud& cloud)
{
    return std::all_of(std::begin(kQuaternion), std::end(kQuaternion),
                       [&](const char* name) { return has_field(cloud, name); });
}

PosePath path_poses(const Cloud& cloud)
{
    Eigen::Matrix4Xd q(4, cloud.size());
    for (Eigen::Index k = 0; k < 4; ++k) q.row(k) = field(cloud, kQuaternion[k]);
    PosePath poses(static_cast<std::size_t>(cloud.size()));
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        Eigen::Isometry3d& pose = poses[static_cast<std::size_t>(i)];
        pose.setIdentity();
        pose.translation() = cloud.xyz.col(i);
        const double norm = q.col(i).stableNorm();
        if (norm == 0) throw InputError("point " + std::to_string(i) + ": the quaternion qw qx qy qz is 0");
        if (!std::isfinite(norm) || !cloud.xyz.col(i).allFinite()) {
            pose.translation().setConstant(NAN);
            continue;
        }
        const Eigen::Vector4d unit = q.col(i) / norm;
        pose.linear() = Eigen::Quaterniond(unit[0], unit[1], unit[2], unit[3]).toRotationMatrix();
    }
    return poses;
}

void set_path(Cloud& cloud, const PosePath& poses)
{
    Eigen::Matrix4Xd q(4, cloud.size());
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        const Eigen::Isometry3d& pose = poses[static_cast<std::size_t>(i)];
        cloud.xyz.col(i) = pose.translation();
        const Eigen::Quaterniond turn(pose.linear());
        const double sign = turn.w() < 0 ? -1 : 1; // one of two signs
        q.col(i) << sign * turn.w(), sign * turn.x(), sign * turn.y(), sign * turn.z();
        if (pose.translation().hasNaN()) q.col(i).setConstant(NAN);
    }
    for (Eigen::Index k = 0; k < 4; ++k) set_field(cloud, kQuaternion[k], q.row(k), 8);
}

} // namespace fettle
