#include "core/constants.h"
#include "core/error.h"
#include "core/fixed_text.h"
#include "program/languages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::program {

namespace {

// A blend radius must be shorter than half the way to the target and from it: controllers refuse overlapping blends.
constexpr double kMaxBlendShare = 0.49;
constexpr double kAcceleration = 1.2; // m/s², URScript's default of movel

// From the base where the track, which rests, has brought it.
Eigen::Isometry3d target_in_resting_base(const robot::Robot& robot, const Step& step)
{
    return controller_world(robot, step.joints[6]).inverse() * controller_world(robot) * target_in_world(robot, step);
}

// p[x, y, z, rx, ry, rz]: m to a tenth of a micrometre, and the rotation vector, rad.
std::string script_pose(const Eigen::Isometry3d& T)
{
    const Eigen::AngleAxisd turn(T.linear());
    const Eigen::Vector3d rotation = turn.angle() * turn.axis();
    std::string text = "p[";
    for (int k = 0; k < 3; ++k) text += core::to_fixed_text(T.translation()[k] / kMmPerMetre, 7) + ", ";
    for (int k = 0; k < 3; ++k) text += core::to_fixed_text(rotation[k], 9) + (k < 2 ? ", " : "]");
    return text;
}

// Moves of a routine, with the distances between them.
std::vector<double> blend_radii(const robot::Robot& robot, const Routine& routine, double zone)
{
    std::vector<Eigen::Vector3d> places;
    std::vector<bool> stops;
    for (const Step& step : routine.steps)
        if (step.is_move()) {
            places.push_back(target_in_resting_base(robot, step).translation());
            stops.push_back(step.stops);
        }
    std::vector<double> radii(places.size(), 0);
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
        const double nearest = std::min((places[i] - places[i - 1]).norm(), (places[i + 1] - places[i]).norm());
        if (!stops[i]) radii[i] = std::min(zone, kMaxBlendShare * nearest);
    }
    return radii;
}

void check_externals(const Program& program)
{
    std::optional<Eigen::Vector2d> first;
    for (const Routine& routine : program.routines)
        for (const Step& step : routine.steps) {
            if (!step.is_move()) continue;
            const Eigen::Vector2d externals = step.joints.tail<2>();
            if (!first) first = externals;
            if (externals != *first)
                throw core::InputError("URScript moves neither a track nor a table, and one moves along the path");
        }
}

std::string routine_text(const Program& program, const Routine& routine)
{
    const robot::Robot& robot = *program.robot;
    const std::string output = "    set_standard_digital_out(" + std::to_string(program.options.process_output) + ", ";
    const std::vector<double> radii = blend_radii(robot, routine, program.options.zone.radius);
    std::string text = "  def " + routine.name + "():\n";
    std::size_t move = 0;
    for (const Step& step : routine.steps) {
        switch (step.kind) {
        case StepKind::move_joints: {
            std::string joints;
            for (int k = 0; k < 6; ++k) joints += (k > 0 ? ", " : "") + core::to_fixed_text(step.joints[k], 9);
            text += "    movej([" + joints +
                    "], v=" + core::to_fixed_text(program.options.joint_speed / 100 * std::numbers::pi, 4) + ")\n";
            ++move;
            break;
        }
        case StepKind::move_linear:
            text += "    movel(" + script_pose(target_in_resting_base(robot, step)) +
                    ", a=" + core::to_fixed_text(kAcceleration, 3) +
                    ", v=" + core::to_fixed_text(step.speed / kMmPerMetre, 7) +
                    ", r=" + core::to_fixed_text(radii[move] / kMmPerMetre, 7) + ")\n";
            ++move;
            break;
        case StepKind::process_on:
            text += output + "True)\n";
            break;
        case StepKind::process_off:
            text += output + "False)\n";
            break;
        case StepKind::force_on:
            // Along z of the tool, which points out of the robot; the other axes are held by position.
            text += "    force_mode(get_actual_tcp_pose(), [0, 0, 1, 0, 0, 0], [0.0, 0.0, " +
                    core::to_fixed_text(program.options.force.value_or(0), 3) +
                    ", 0.0, 0.0, 0.0], 2, [0.1, 0.1, 0.05, 0.35, 0.35, 0.35])\n";
            break;
        case StepKind::force_off:
            text += "    end_force_mode()\n";
            break;
        }
    }
    return text + "  end\n";
}

} // namespace

std::string urscript_text(const Program& program, const std::string& name)
{
    check_externals(program);
    const robot::Robot& robot = *program.robot;
    std::string text = "# " + program.options.remark + "\ndef " + name +
                       "():\n  # poses p[x, y, z, rx, ry, rz] from the robot's base: m, and rotation vectors in rad\n"
                       "  set_tcp(" +
                       script_pose(tool_on_flange(robot)) + ")\n";
    for (const Routine& routine : program.routines) text += routine_text(program, routine);
    for (const Routine& routine : program.routines) text += "  " + routine.name + "()\n";
    return text + "end\n";
}

} // namespace fettle::program
