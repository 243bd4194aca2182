#pragma once

#include "cloud/cloud.h"
#include "robot/solve_path.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Robot programs: a neutral one, made from a path, and its text in the languages of four makers.
namespace fettle::program {

inline constexpr double kMmPerMetre = 1000;

enum class StepKind {
    move_joints, ///< each joint evenly
    move_linear, ///< the tip straight
    process_on,  ///< spindle or belt on, by a digital output
    process_off,
    force_on, ///< press along the tool's axis with Program::force
    force_off
};

struct Step {
    StepKind kind = StepKind::move_linear;
    Eigen::Isometry3d T_part_tool = Eigen::Isometry3d::Identity(); ///< of moves, the tool's z towards the holder
    robot::CellJoints joints = robot::CellJoints::Zero();          ///< of moves
    double speed = 0;                                              ///< of the tip, mm/s
    bool stops = false; ///< on the target; else it is rounded off by the zone

    bool is_move() const { return kind == StepKind::move_joints || kind == StepKind::move_linear; }
};

/// The work on one anomaly.
struct Routine {
    std::string name; ///< letters, digits and _, at most 16, as all four languages allow
    std::vector<Step> steps;
};

/// How near the tip must come to a target before it turns to the next, under the name of RAPID's zonedata.
struct Zone {
    std::string name = "z0";
    double radius = 0.3; ///< mm
};
/// The zones that a command line may name: fine, z0, z1, z5, z10.
const std::vector<Zone>& zones();

struct ProgramOptions {
    Eigen::VectorXd speeds; ///< N, mm/s, of the motion to each pose
    double turn_rate = 0;   ///< limit, rad/s
    Zone zone;
    double joint_speed = 20;                 ///< of moves by joints, % of the robot's own
    int process_output = 1;                  ///< digital output that switches the process on
    std::optional<double> force;             ///< N, while the tool is on a stroke; nothing: the path's positions hold
    std::optional<robot::Coupling> coupling; ///< how the controller counts joint 3, if a URDF does not say it
    std::string remark;                      ///< the first line: which check the path has passed, or that it has not
};

/// A neutral program. Robot files and paths are in the cell; controllers count from the robot's base (with its track at
/// 0), which their world frame coincides with (robot::ControllerFrames).
struct Program {
    const robot::Robot* robot = nullptr;
    ProgramOptions options;
    std::vector<Routine> routines; ///< called one after the other
};

/// A file of a program.
struct ProgramFile {
    std::string name; ///< without a folder
    std::string text;
};

/// Makes a program from a solved path: to its first pose by joints, then straight from pose to pose. A routine for each
/// value of the field `anomaly`, in the order of the path, or one. The process runs from before a routine's first
/// approach to after its last retract; force control from a stroke's first point to its last. The tip stops where
/// something is switched.
/// @param robot  must outlive it
/// @throws InputError if a pose is not reached, or the frames that the robot's controller counts in are unknown
Program make_program(const robot::Robot& robot, const cloud::Cloud& path, const robot::SolvedPath& solved,
                     const ProgramOptions& options);

/// T_cell_world: the frame that the robot's controller counts from, with the track at a position, mm.
Eigen::Isometry3d controller_world(const robot::Robot& robot, double track = 0);
/// T_world_tool as makers count it, z out of the robot: the track at 0, the table as at the step.
Eigen::Isometry3d target_in_world(const robot::Robot& robot, const Step& step);
/// T_flange_tool as makers count it, z out of the robot.
Eigen::Isometry3d tool_on_flange(const robot::Robot& robot);
/// T_part_tool with the tool's z out of the robot.
Eigen::Isometry3d outward_tool(const Eigen::Isometry3d& T);

/// Angles of R = R_z(first) R_y(second) R_x(third), degrees: KUKA's A, B, C and Fanuc's R, P, W.
Eigen::Vector3d z_y_x_angles(const Eigen::Matrix3d& rotation);

/// Name of a program from that of its file: its letters and digits, others as _, at most 16, a letter first.
std::string program_name(const std::string& file);

} // namespace fettle::program
