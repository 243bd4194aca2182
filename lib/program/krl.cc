#include "core/constants.h"
#include "core/fixed_text.h"
#include "program/languages.h"

namespace fettle::program {

namespace {

// "X 1,Y 2,Z 3,A 4,B 5,C 6": a tenth of a micrometre, and degrees that give as much at the end of a tool 1 m long.
std::string frame_text(const Eigen::Isometry3d& T)
{
    const Eigen::Vector3d angles = z_y_x_angles(T.linear());
    return "X " + core::to_fixed_text(T.translation().x(), 4) + ",Y " + core::to_fixed_text(T.translation().y(), 4) +
           ",Z " + core::to_fixed_text(T.translation().z(), 4) + ",A " + core::to_fixed_text(angles[0], 6) + ",B " +
           core::to_fixed_text(angles[1], 6) + ",C " + core::to_fixed_text(angles[2], 6);
}

// The track is E1, the table the next.
std::string krl_axes(const robot::Robot& robot, const robot::CellJoints& joints)
{
    std::string text;
    if (robot.track) text += ",E1 " + core::to_fixed_text(joints[6], 4);
    if (robot.table)
        text += std::string(robot.track ? ",E2 " : ",E1 ") + core::to_fixed_text(joints[7] / core::kRadPerDegree, 6);
    return text;
}

// On a table the base turns with it: EK() couples the two (KUKA.SystemSoftware, "mathematically coupled kinematics").
std::string base_text(const robot::Robot& robot)
{
    if (!robot.table) return "  $BASE={" + frame_text(controller_world(robot).inverse()) + "}\n";
    Eigen::Isometry3d T_table_part = Eigen::Isometry3d::Identity();
    T_table_part.translation() = -robot.table->point;
    return "  $BASE=EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,{" + frame_text(T_table_part) + "})\n";
}

class Writer {
  public:
    explicit Writer(const Program& program) : program_(program), robot_(*program.robot) {}

    std::string routine(const Routine& routine)
    {
        text_ = "DEF " + routine.name + "( )\n";
        for (const Step& step : routine.steps) add(step);
        return text_ + "END\n";
    }

  private:
    void add(const Step& step)
    {
        const std::string output = "  $OUT[" + std::to_string(program_.options.process_output) + "]=";
        switch (step.kind) {
        case StepKind::move_joints: {
            std::string axes;
            for (int k = 0; k < 6; ++k)
                axes += (k > 0 ? ",A" : "A") + std::to_string(k + 1) + " " +
                        core::to_fixed_text(step.joints[k] / core::kRadPerDegree, 6);
            text_ += "  PTP {E6AXIS: " + axes + krl_axes(robot_, step.joints) + "}\n";
            break;
        }
        case StepKind::move_linear:
            if (step.speed != speed_) text_ += "  $VEL.CP=" + core::to_fixed_text(step.speed / kMmPerMetre, 7) + "\n";
            speed_ = step.speed;
            text_ += "  LIN {E6POS: " + frame_text(outward_tool(step.T_part_tool)) + krl_axes(robot_, step.joints) +
                     (step.stops || program_.options.zone.radius == 0 ? "}\n" : "} C_DIS\n");
            break;
        case StepKind::process_on:
            text_ += output + "TRUE\n";
            break;
        case StepKind::process_off:
            text_ += output + "FALSE\n";
            break;
        case StepKind::force_on:
            text_ += "  ; force control is an option (KUKA.ForceTorqueControl): press with " +
                     core::to_fixed_text(program_.options.force.value_or(0), 3) + " N along the tool from here\n";
            break;
        case StepKind::force_off:
            text_ += "  ; force control: off\n";
            break;
        }
    }

    const Program& program_;
    const robot::Robot& robot_;
    std::string text_;
    double speed_ = -1; ///< mm/s, as $VEL.CP was set last
};

} // namespace

std::string krl_text(const Program& program, const std::string& name)
{
    const robot::Robot& robot = *program.robot;
    const ProgramOptions& options = program.options;
    std::string text =
        "DEF " + name + "( ) ; " + options.remark +
        "\n  ; positions in $BASE (mm, A, B, C about z, y, x in degrees), the world frame is the robot's "
        "base; E1, E2: track (mm), table (degrees)\n"
        "  BAS(#INITMOV,0)\n  BAS(#VEL_PTP," +
        core::to_fixed_text(options.joint_speed, 3) + ")\n" + base_text(robot) + "  $TOOL={" +
        frame_text(tool_on_flange(robot)) +
        "}\n  $VEL.ORI1=" + core::to_fixed_text(options.turn_rate / core::kRadPerDegree, 4) +
        "\n  $VEL.ORI2=" + core::to_fixed_text(options.turn_rate / core::kRadPerDegree, 4) +
        "\n  $APO.CDIS=" + core::to_fixed_text(options.zone.radius, 4) + "\n";
    for (const Routine& routine : program.routines) text += "  " + routine.name + "( )\n";
    text += "END\n";
    for (const Routine& routine : program.routines) text += Writer(program).routine(routine);
    return text;
}

} // namespace fettle::program
