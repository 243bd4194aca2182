#include "core/constants.h"
#include "core/error.h"
#include "core/fixed_text.h"
#include "core/text.h"
#include "program/languages.h"
#include "robot/arm.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

namespace fettle::program {

namespace {

// By which a URDF may have the world frame off axis 2's height, mm: they round lengths to 0.1 mm.
constexpr double kMaxWorldHeight = 1;

std::string upper(std::string text)
{
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

// A remark of an instruction, at most 32 characters of ASCII, as the teach pendant shows.
std::string remark(const std::string& text)
{
    std::string ascii;
    for (const char c : text.substr(0, 32)) ascii += c >= ' ' && c <= '~' && c != ';' ? c : '-';
    return "  !" + ascii + " ;";
}

// World coordinates begin at axis 2's height over the base, or where a URDF says.
Eigen::Isometry3d target_in_fanuc_world(const robot::Robot& robot, const Step& step)
{
    Eigen::Isometry3d T = target_in_world(robot, step);
    if (!robot.controller) T.translation().z() -= robot.dh[0].d;
    return T;
}

void check_world(const robot::Robot& robot)
{
    if (!robot.controller) return;
    const Eigen::Vector3d axis_2(0, 0, robot.dh[0].d);
    const double over_world = (robot.controller->T_base_world.inverse() * axis_2).z();
    if (std::abs(over_world) > kMaxWorldHeight)
        throw core::InputError("axis 2 is " + core::to_short_text(over_world) +
                               " mm over the link base, and Fanuc's controllers count from its height");
}

// "N U T, 0, 0, 0": wrist flipped or not (joint 5 positive or not), elbow up or down, wrist centre to the front of axis
// 1 or to its back; turns of joints 1, 4 and 6.
std::string configuration(const robot::Robot& robot, const robot::Joints& joints)
{
    const auto frames = robot::Arm(robot).frames(joints);
    const Eigen::Vector3d forward = frames[1].linear().col(0);
    const auto in_plane = [&](const Eigen::Vector3d& v) { return Eigen::Vector2d(v.dot(forward), v.z()); };
    const Eigen::Vector2d arm = in_plane(frames[2].translation() - frames[1].translation());
    const Eigen::Vector2d wrist = in_plane(frames[4].translation() - frames[1].translation());
    const bool is_front = in_plane(frames[4].translation()).x() >= 0;
    const double elbow = wrist.x() * arm.y() - wrist.y() * arm.x();
    const bool is_up = is_front ? elbow >= 0 : elbow <= 0;
    std::string text =
        std::string("'") + (joints[4] > 0 ? "F " : "N ") + (is_up ? "U " : "D ") + (is_front ? "T" : "B");
    for (const int k : {0, 3, 5}) text += ", " + std::to_string(std::lround(joints[k] / (2 * std::numbers::pi)));
    return text + "'";
}

std::string fanuc_axes(const robot::Robot& robot, const robot::CellJoints& joints)
{
    std::string text;
    if (robot.track) text += ",\n\tE1 = " + core::to_fixed_text(joints[6], 4) + " mm";
    if (robot.table)
        text += std::string(",\n\t") + (robot.track ? "E2 = " : "E1 = ") +
                core::to_fixed_text(joints[7] / core::kRadPerDegree, 6) + " deg";
    return text;
}

std::string position_text(const robot::Robot& robot, const Step& step, std::uint64_t index)
{
    std::string text = "P[" + std::to_string(index) + "]{\n   GP1:\n\tUF : 0, UT : 1,";
    if (step.kind == StepKind::move_joints) {
        const Eigen::VectorXd q = fanuc_joints(robot, step.joints.head<6>());
        for (int k = 0; k < 6; ++k)
            text += std::string(k == 0 ? "\n" : ",\n") + "\tJ" + std::to_string(k + 1) + " = " +
                    core::to_fixed_text(q[k], 6) + " deg";
    } else {
        const Eigen::Isometry3d T = target_in_fanuc_world(robot, step);
        const Eigen::Vector3d zyx = z_y_x_angles(T.linear());
        text += "\tCONFIG : " + configuration(robot, step.joints.head<6>()) +
                ",\n\tX = " + core::to_fixed_text(T.translation().x(), 4) +
                " mm,\tY = " + core::to_fixed_text(T.translation().y(), 4) +
                " mm,\tZ = " + core::to_fixed_text(T.translation().z(), 4) +
                " mm,\n\tW = " + core::to_fixed_text(zyx[2], 6) + " deg,\tP = " + core::to_fixed_text(zyx[1], 6) +
                " deg,\tR = " + core::to_fixed_text(zyx[0], 6) + " deg";
    }
    return text + fanuc_axes(robot, step.joints) + "\n};\n";
}

// CNT in per cent of the smoothing that the controller can do.
std::string termination(const Step& step, const Zone& zone)
{
    if (step.stops || zone.radius == 0) return "FINE";
    return "CNT" + std::to_string(std::min(100L, std::lround(zone.radius * 10)));
}

/// One LS file.
class File {
  public:
    explicit File(const Program& program) : program_(&program) {}

    void add_line(const std::string& text) { lines_ += fanuc_line_number(++line_count_) + text + "\n"; }

    void add(const Step& step)
    {
        const std::string output = "  DO[" + std::to_string(program_->options.process_output) + "]=";
        const std::string end = " " + termination(step, program_->options.zone) + "    ;";
        if (step.is_move()) positions_ += position_text(*program_->robot, step, ++position_count_);
        const std::string target = "P[" + std::to_string(position_count_) + "] ";
        switch (step.kind) {
        case StepKind::move_joints:
            add_line("J " + target + std::to_string(std::max(1L, std::lround(program_->options.joint_speed))) + "%" +
                     end);
            break;
        case StepKind::move_linear:
            add_line("L " + target + core::to_fixed_text(step.speed, 1) + "mm/sec" + end);
            break;
        case StepKind::process_on:
            add_line(output + "ON ;");
            break;
        case StepKind::process_off:
            add_line(output + "OFF ;");
            break;
        case StepKind::force_on:
            add_line(remark("Force Control (option): " + core::to_fixed_text(program_->options.force.value_or(0), 1) +
                            " N"));
            break;
        case StepKind::force_off:
            add_line(remark("Force Control: off"));
            break;
        }
    }

    std::uint64_t line_count() const { return line_count_; }

    std::string text(const std::string& name) const
    {
        const std::string comment = program_->options.remark.substr(0, program_->options.remark.find(' '));
        return "/PROG  " + name + "\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"" + comment.substr(0, 16) +
               "\";\nPROG_SIZE\t= 0;\nFILE_NAME\t= ;\nVERSION\t\t= 0;\nLINE_COUNT\t= " + std::to_string(line_count_) +
               ";\nMEMORY_SIZE\t= 0;\nPROTECT\t\t= READ_WRITE;\nTCD:  STACK_SIZE\t= 0,\n      TASK_PRIORITY\t= 50,\n"
               "      TIME_SLICE\t= 0,\n      BUSY_LAMP_OFF\t= 0,\n      ABORT_REQUEST\t= 0,\n"
               "      PAUSE_REQUEST\t= 0;\nDEFAULT_GROUP\t= 1,*,*,*,*;\nCONTROL_CODE\t= 00000000 00000000;\n/MN\n" +
               lines_ + "/POS\n" + positions_ + "/END\n";
    }

  private:
    const Program* program_;
    std::string lines_, positions_;
    std::uint64_t line_count_ = 0, position_count_ = 0;
};

} // namespace

std::string fanuc_line_number(std::uint64_t number)
{
    const std::string digits = std::to_string(number);
    return std::string(digits.size() < 4 ? 4 - digits.size() : 0, ' ') + digits + ":";
}

Eigen::VectorXd fanuc_joints(const robot::Robot& robot, const robot::Joints& joints)
{
    return from_horizontal(robot, joints) / core::kRadPerDegree;
}

std::vector<ProgramFile> fanuc_files(const Program& program, const std::string& name, std::uint64_t max_lines)
{
    check_world(*program.robot);
    File main(program);
    main.add_line(remark(program.options.remark));
    main.add_line("  UFRAME_NUM=0 ;");
    main.add_line("  UTOOL_NUM=1 ;");
    const Eigen::Isometry3d tool = tool_on_flange(*program.robot);
    const Eigen::Vector3d zyx = z_y_x_angles(tool.linear());
    const double numbers[] = {
        tool.translation().x(), tool.translation().y(), tool.translation().z(), zyx[2], zyx[1], zyx[0]};
    // A line for each number: a remark's end is cut off.
    for (std::size_t k = 0; k < 6; ++k)
        main.add_line(remark(std::string("UTOOL 1: ") + "XYZWPR"[k] + " " + core::to_fixed_text(numbers[k], 4)));
    std::vector<ProgramFile> files;
    const auto close = [&](const File& file) {
        const std::string called = upper(name.substr(0, 12)) + "_" + std::to_string(files.size() + 1);
        main.add_line("  CALL " + called + "    ;");
        files.push_back({called + ".ls", file.text(called)});
    };
    for (const Routine& routine : program.routines) {
        File file(program);
        file.add_line(remark(routine.name));
        for (const Step& step : routine.steps) {
            if (file.line_count() >= max_lines) {
                close(file);
                file = File(program);
                file.add_line(remark(routine.name + ", continued"));
            }
            file.add(step);
        }
        close(file);
    }
    files.insert(files.begin(), {upper(name) + ".ls", main.text(upper(name))});
    return files;
}

} // namespace fettle::program
