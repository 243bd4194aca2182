#include "program/languages.h"

#include "core/constants.h"
#include "core/fixed_text.h"
#include "robot/arm.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fettle::program {

namespace {

// The speeds of external axes in RAPID's predefined speeddata: mm/s and degrees/s.
constexpr const char* kExternalSpeeds = "5000,1000";
constexpr double kFastestTip = 7000;   // v7000, mm/s
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

std::string external_axes(const robot::Robot& robot, const Eigen::Vector2d& externals)
{
    const std::string track = robot.track ? core::to_fixed_text(externals[0], 4) : kNoAxis;
    const std::string table = robot.table ? core::to_fixed_text(externals[1] / core::kRadPerDegree, 6) : kNoAxis;
    return "[" + track + "," + table + ",9E9,9E9,9E9,9E9]";
}

// With a table the part is fixed to a mechanical unit. Its user frame has its origin on the table's axis, and is
// parallel to the cell's frame with the table at 0.
std::string work_object(const robot::Robot& robot)
{
    Eigen::Isometry3d T_user_part = Eigen::Isometry3d::Identity();
    const std::string identity = pose_text(T_user_part);
    if (!robot.table) return "[FALSE,TRUE,\"\"," + pose_text(controller_world(robot).inverse()) + "," + identity + "]";
    T_user_part.translation() = -robot.table->point;
    return "[FALSE,FALSE,\"" + (robot.table->unit.empty() ? "STN1" : robot.table->unit) + "\"," + identity + "," +
           pose_text(T_user_part) + "]";
}

// A speed of 12.5 mm/s is called v_12_5.
std::string speed_name(double speed)
{
    std::string name = "v_" + core::to_fixed_text(speed, 4);
    std::ranges::replace(name, '.', '_');
    return name;
}

/// The body of a routine; `target` is the number of its first target.
std::string procedure(const Program& program, const Routine& routine, std::size_t target, std::size_t begin)
{
    const std::string output = "fettle_do" + std::to_string(program.options.process_output);
    std::string text = "  PROC " + routine.name + "()\n";
    for (const Step& step : routine.steps) {
        const std::string end =
            std::string(step.stops ? "fine" : program.options.zone.name) + ", fettle_tool \\WObj:=fettle_part;\n";
        switch (step.kind) {
        case StepKind::move_joints:
            text += "    MoveAbsJ begin" + std::to_string(begin) + ", v_joints, " + end;
            ++target;
            break;
        case StepKind::move_linear:
            text += "    MoveL p" + std::to_string(target++) + ", " + speed_name(step.speed) + ", " + end;
            break;
        case StepKind::process_on:
            text += "    SetDO " + output + ", 1;\n";
            break;
        case StepKind::process_off:
            text += "    SetDO " + output + ", 0;\n";
            break;
        case StepKind::force_on:
            text += "    ! Force control is an option (Machining FC): FCPress1LStart presses with " +
                    core::to_fixed_text(program.options.force.value_or(0), 3) + " N along the tool\n";
            break;
        case StepKind::force_off:
            text += "    ! Force control: FCPressEnd\n";
            break;
        }
    }
    return text + "  ENDPROC\n";
}

} // namespace

Eigen::Vector4i rapid_configuration(const robot::Robot& robot, robot::Coupling coupling, const robot::Joints& joints)
{
    const auto quadrant = [&](Eigen::Index k) {
        return static_cast<int>(std::floor(joints[k] / (core::kRadPerDegree * 90)));
    };
    Eigen::Vector4i configuration(quadrant(0), quadrant(3), quadrant(5), 0);
    if (coupling == robot::Coupling::parallelogram) return configuration;
    const auto frames = robot::Arm(robot).frames(joints);
    const Eigen::Vector3d forward = frames[1].linear().col(0);
    const auto in_plane = [&](const Eigen::Vector3d& v) { return Eigen::Vector2d(v.dot(forward), v.z()); };
    const Eigen::Vector2d wrist_from_axis1 = in_plane(frames[4].translation());
    const Eigen::Vector2d arm = in_plane(frames[2].translation() - frames[1].translation());
    const Eigen::Vector2d wrist = in_plane(frames[4].translation() - frames[1].translation());
    const bool behind_arm = arm.x() * wrist.y() - arm.y() * wrist.x() > 0;
    configuration[3] = (wrist_from_axis1.x() < 0 ? 4 : 0) + (behind_arm ? 2 : 0) + (joints[4] < 0 ? 1 : 0);
    return configuration;
}

std::string rapid_text(const Program& program)
{
    const robot::Robot& robot = *program.robot;
    const ProgramOptions& options = program.options;
    const robot::Coupling coupling = options.coupling.value_or(robot.coupling);
    const auto counted = [&](const robot::Joints& joints) {
        return coupling == robot::Coupling::parallelogram ? from_horizontal(robot, joints) : joints;
    };
    std::string text =
        "MODULE fettle_path ! " + options.remark +
        "\n  ! robtarget: position (mm), q1,q2,q3,q4 = w,x,y,z, cf1,cf4,cf6,cfx, eax_a = track (mm), eax_b = table "
        "(deg)\n  ! z of the tool points from the holder to the tip. The tool's load is to be measured. The world "
        "frame "
        "is the robot's base.\n  PERS tooldata fettle_tool := [TRUE," +
        pose_text(tool_on_flange(robot)) +
        ",[1,[0,0,1],[1,0,0,0],0,0,0]];\n  PERS wobjdata fettle_part := " + work_object(robot) + ";\n";
    std::set<double> speeds;
    for (const Routine& routine : program.routines)
        for (const Step& step : routine.steps)
            if (step.is_move()) speeds.insert(step.speed);
    const std::string turn = core::to_fixed_text(options.turn_rate / core::kRadPerDegree, 4);
    for (const double speed : speeds)
        text += "  CONST speeddata " + speed_name(speed) + " := [" + core::to_fixed_text(speed, 4) + "," + turn + "," +
                kExternalSpeeds + "];\n";
    // Moves by joints at a tip speed of their own share of RAPID's fastest predefined one.
    text += "  CONST speeddata v_joints := [" + core::to_fixed_text(kFastestTip * options.joint_speed / 100, 4) + "," +
            turn + "," + kExternalSpeeds + "];\n";
    std::string procedures;
    std::size_t target = 1, begin = 1;
    for (const Routine& routine : program.routines) {
        procedures += procedure(program, routine, target, begin);
        for (const Step& step : routine.steps) {
            if (!step.is_move()) continue;
            const auto q = step.joints;
            if (step.kind == StepKind::move_joints)
                text += "  CONST jointtarget begin" + std::to_string(begin++) + " := [" +
                        array_text(counted(q.head<6>()) / core::kRadPerDegree, 6) + "," +
                        external_axes(robot, q.tail<2>()) + "];\n";
            const std::string pose = pose_text(outward_tool(step.T_part_tool));
            text += "  CONST robtarget p" + std::to_string(target++) + " := " + pose.substr(0, pose.size() - 1) + "," +
                    array_text(rapid_configuration(robot, coupling, q.head<6>()).cast<double>(), 0) + "," +
                    external_axes(robot, q.tail<2>()) + "];\n";
        }
    }
    text += "  PROC main()\n    ConfJ \\On;\n    ConfL \\On;\n";
    for (const Routine& routine : program.routines) text += "    " + routine.name + ";\n";
    return text + "  ENDPROC\n" + procedures + "ENDMODULE\n";
}

} // namespace fettle::program
