#include "program/program.h"

#include "cloud/poses.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "program/languages.h"
#include "robot/arm_report.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace fettle::program {

namespace {

using cloud::Motion;

// Maximum length of a program's name: the shortest bound of the four languages.
constexpr std::size_t kMaxNameLength = 16;
// Below this cosine of the second angle the first and the third turn about one axis.
constexpr double kMinAngleCosine = 1e-9;

class RoutineBuilder {
  public:
    RoutineBuilder(const robot::SolvedPath& solved, const std::vector<Motion>& motions, const ProgramOptions& options)
        : solved_(solved), motions_(motions), options_(options)
    {
    }

    /// The poses from `first` to before `end`.
    std::vector<Step> steps(std::size_t first, std::size_t end)
    {
        steps_.clear();
        std::size_t last_on_part = first;
        for (std::size_t i = first; i < end; ++i)
            if (motions_[i] <= Motion::approach) last_on_part = i;
        bool is_running = false, is_pressing = false;
        for (std::size_t i = first; i < end; ++i) {
            add_move(i, i == first);
            const bool approaches_next = i + 1 < end && motions_[i + 1] <= Motion::approach;
            const bool is_contact = motions_[i] == Motion::stroke || (motions_[i] == Motion::approach && i + 1 < end &&
                                                                      motions_[i + 1] == Motion::stroke);
            const bool is_stroke_next = i + 1 < end && motions_[i + 1] == Motion::stroke;
            if (!is_running && approaches_next) is_running = switch_to(StepKind::process_on);
            if (options_.force && !is_pressing && is_contact && is_stroke_next)
                is_pressing = switch_to(StepKind::force_on);
            else if (is_pressing && !is_stroke_next)
                is_pressing = !switch_to(StepKind::force_off);
            if (is_running && i == last_on_part) is_running = !switch_to(StepKind::process_off);
        }
        for (auto step = steps_.rbegin(); step != steps_.rend(); ++step)
            if (step->is_move()) {
                step->stops = true;
                break;
            }
        return steps_;
    }

  private:
    void add_move(std::size_t i, bool is_first)
    {
        steps_.push_back({is_first ? StepKind::move_joints : StepKind::move_linear, solved_.poses[i],
                          solved_.path.joints.col(i), options_.speeds[i], is_first});
    }

    bool switch_to(StepKind kind)
    {
        Step& before = steps_.back();
        if (before.is_move()) before.stops = true;
        Step step;
        step.kind = kind;
        steps_.push_back(step);
        return true;
    }

    const robot::SolvedPath& solved_;
    const std::vector<Motion>& motions_;
    const ProgramOptions& options_;
    std::vector<Step> steps_;
};

} // namespace

const std::vector<Zone>& zones()
{
    // ABB, RAPID reference manual, "zonedata": pzone_tcp, mm.
    static const std::vector<Zone> all = {{"fine", 0}, {"z0", 0.3}, {"z1", 1}, {"z5", 5}, {"z10", 10}};
    return all;
}

Program make_program(const robot::Robot& robot, const cloud::Cloud& path, const robot::SolvedPath& solved,
                     const ProgramOptions& options)
{
    if (const std::string obstacle = robot::path_obstacle(robot, solved.path, std::nullopt); !obstacle.empty())
        throw core::InputError(obstacle);
    if (!robot.no_controller.empty()) throw core::InputError("no program can be written: " + robot.no_controller);
    const std::vector<Motion> motions = cloud::read_motions(path);
    const Eigen::VectorXd anomaly = cloud::has_field(path, "anomaly")
                                        ? cloud::field(path, "anomaly")
                                        : Eigen::VectorXd(Eigen::VectorXd::Constant(path.size(), core::kNaN));
    Program program = {&robot, options, {}};
    RoutineBuilder builder(solved, motions, options);
    std::size_t first = 0;
    for (std::size_t i = 1; i <= solved.poses.size(); ++i) {
        if (i < solved.poses.size() && (std::isnan(anomaly[i]) || anomaly[i] == anomaly[first])) continue;
        const std::string number = core::to_short_text(anomaly[first]);
        const std::string name = std::isnan(anomaly[first]) ? "fettle_path" : program_name("anomaly_" + number);
        program.routines.push_back({name, builder.steps(first, i)});
        first = i;
    }
    // An anomaly that the path comes back to has a routine each time.
    for (std::size_t k = 0; k < program.routines.size(); ++k)
        for (std::size_t before = 0; before < k; ++before)
            if (program.routines[before].name == program.routines[k].name)
                program.routines[k].name = program_name("part_" + std::to_string(k + 1));
    return program;
}

Eigen::Isometry3d outward_tool(const Eigen::Isometry3d& T)
{
    return T * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
}

Eigen::Isometry3d controller_world(const robot::Robot& robot, double track)
{
    const Eigen::Isometry3d T_cell_base = robot::base_in_cell(robot, track);
    return robot.controller ? T_cell_base * robot.controller->T_base_world : T_cell_base;
}

Eigen::Isometry3d target_in_world(const robot::Robot& robot, const Step& step)
{
    return outward_tool(controller_world(robot).inverse() * robot::part_in_cell(robot, step.joints[7]) *
                        step.T_part_tool);
}

Eigen::Isometry3d tool_on_flange(const robot::Robot& robot)
{
    const Eigen::Isometry3d T_6_tool = outward_tool(robot.T_flange_tool);
    return robot.controller ? robot.controller->T_6_flange.inverse() * T_6_tool : T_6_tool;
}

robot::Joints from_horizontal(const robot::Robot& robot, robot::Joints q)
{
    // The forearm's angle to the horizontal is the sum of both turns about parallel axes; of opposite ones a
    // difference.
    if (robot.coupling == robot::Coupling::serial) q[2] += robot.dh[1].sign * robot.dh[2].sign * q[1];
    return q;
}

Eigen::Vector3d z_y_x_angles(const Eigen::Matrix3d& R)
{
    const double cosine = std::hypot(R(0, 0), R(1, 0));
    Eigen::Vector3d angles(std::atan2(R(1, 0), R(0, 0)), std::atan2(-R(2, 0), cosine), std::atan2(R(2, 1), R(2, 2)));
    if (cosine < kMinAngleCosine) angles << std::atan2(-R(0, 1), R(1, 1)), angles[1], 0;
    return angles / core::kRadPerDegree;
}

std::string program_name(const std::string& file)
{
    std::string name;
    for (const char c : std::filesystem::path(file).stem().string())
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128 ? c : '_';
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name[0])) == 0) name.insert(0, "p");
    return name.substr(0, kMaxNameLength);
}

} // namespace fettle::program
