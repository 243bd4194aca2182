#include "robot/rapid.h"

#include "core/constants.h"
#include "core/fixed_text.h"
#include "robot/arm.h"

#include <cmath>
#include <numbers>
#include <ostream>

namespace fettle::robot {

namespace {

// The speeds of external axes in RAPID's predefined speeddata: mm/s and degrees/s.
constexpr const char* kExternalSpeeds = "5000,1000";
constexpr const char* kNoAxis = "9E9"; // RAPID's value of an axis that does not exist

std::string array_text(const Eigen::VectorXd& numbers, int digits)
{
    std::string text = "[";
    for (Eigen::Index i = 0; i < numbers.size(); ++i)
        text += (i > 0 ? "," : "") + core::to_fixed_text(numbers[i], digits);
    return text + "]";
}

// "[[x,y,z],[q1,q2,q3,q4]]". Positions are written to 1e-4 mm; nine digits of the quaternion give as much at the end of
// a tool 1 m long.
std::string pose_text(const Eigen::Isometry3d& T)
{
    const Eigen::Quaterniond q(T.linear());
    const double sign = q.w() < 0 ? -1 : 1;
    return "[" + array_text(T.translation(), 4) + "," +
           array_text(sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), 9) + "]";
}

std::string external_axes(const Robot& robot, const Eigen::Vector2d& externals)
{
    const std::string track = robot.track ? core::to_fixed_text(externals[0], 4) : kNoAxis;
    const std::string table = robot.table ? core::to_fixed_text(externals[1] / core::kRadPerDegree, 6) : kNoAxis;
    return "[" + track + "," + table + ",9E9,9E9,9E9,9E9]";
}

// With a table the part is fixed to a mechanical unit. Its user frame has its origin on the table's axis, and is
// parallel to the cell's frame with the table at 0.
std::string work_object(const Robot& robot)
{
    Eigen::Isometry3d T_user_part = Eigen::Isometry3d::Identity();
    const std::string identity = pose_text(T_user_part);
    if (!robot.table) return "[FALSE,TRUE,\"\"," + identity + "," + identity + "]";
    T_user_part.translation() = -robot.table->point;
    return "[FALSE,FALSE,\"" + (robot.table->unit.empty() ? "STN1" : robot.table->unit) + "\"," + identity + "," +
           pose_text(T_user_part) + "]";
}

// Turns the tool's z to point out of the robot, as in RAPID.
Eigen::Isometry3d to_rapid_tool(const Eigen::Isometry3d& T)
{
    return T * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
}

} // namespace

Eigen::Vector4i rapid_configuration(const Robot& robot, const Joints& joints)
{
    const auto quadrant = [&](Eigen::Index k) {
        return static_cast<int>(std::floor(joints[k] / (core::kRadPerDegree * 90)));
    };
    Eigen::Vector4i configuration(quadrant(0), quadrant(3), quadrant(5), 0);
    if (robot.coupling == Coupling::parallelogram) return configuration;
    const auto frames = Arm(robot).frames(joints);
    const Eigen::Vector3d forward = frames[1].linear().col(0);
    const auto in_plane = [&](const Eigen::Vector3d& v) { return Eigen::Vector2d(v.dot(forward), v.z()); };
    const Eigen::Vector2d wrist_from_axis1 = in_plane(frames[4].translation());
    const Eigen::Vector2d arm = in_plane(frames[2].translation() - frames[1].translation());
    const Eigen::Vector2d wrist = in_plane(frames[4].translation() - frames[1].translation());
    const bool behind_arm = arm.x() * wrist.y() - arm.y() * wrist.x() > 0;
    configuration[3] = (wrist_from_axis1.x() < 0 ? 4 : 0) + (behind_arm ? 2 : 0) + (joints[4] < 0 ? 1 : 0);
    return configuration;
}

void write_rapid(std::ostream& out, const Robot& robot, const cloud::PosePath& poses, const FollowedPath& path,
                 const RapidOptions& options)
{
    out << "MODULE fettle_path\n"
        << "  ! robtarget: position (mm), q1,q2,q3,q4 = w,x,y,z, cf1,cf4,cf6,cfx, eax_a = track (mm), eax_b = table "
           "(deg)\n"
        << "  ! z of the tool points from the holder to the tip. The tool's load is to be measured.\n"
        << "  PERS tooldata fettle_tool := [TRUE," << pose_text(to_rapid_tool(robot.T_flange_tool))
        << ",[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
        << "  PERS wobjdata fettle_part := " << work_object(robot) << ";\n"
        << "  CONST speeddata fettle_speed := [" << core::to_fixed_text(options.feed.tip_speed, 4) << ","
        << core::to_fixed_text(options.feed.turn_rate / core::kRadPerDegree, 4) << "," << kExternalSpeeds << "];\n"
        << "  CONST jointtarget begin := [" << array_text(path.joints.col(0).head<6>() / core::kRadPerDegree, 6) << ","
        << external_axes(robot, path.joints.col(0).tail<2>()) << "];\n";
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto q = path.joints.col(i);
        const std::string target = pose_text(to_rapid_tool(poses[i]));
        out << "  CONST robtarget p" << i + 1 << " := " << target.substr(0, target.size() - 1) << ","
            << array_text(rapid_configuration(robot, q.head<6>()).cast<double>(), 0) << ","
            << external_axes(robot, q.tail<2>()) << "];\n";
    }
    out << "  PROC main()\n    ConfJ \\On;\n    ConfL \\On;\n"
        << "    MoveAbsJ begin, fettle_speed, fine, fettle_tool \\WObj:=fettle_part;\n";
    for (std::size_t i = 1; i < poses.size(); ++i)
        out << "    MoveL p" << i + 1 << ", fettle_speed, " << (i + 1 == poses.size() ? "fine" : options.zone)
            << ", fettle_tool \\WObj:=fettle_part;\n";
    out << "  ENDPROC\nENDMODULE\n";
}

} // namespace fettle::robot
