#include "program/program_options.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "program/languages.h"
#include "robot/path_cloud.h"
#include "robot/path_stamp.h"

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <vector>

namespace fettle::program {

namespace {

// Joints found again for the poses of a checked path differ by rounding only, rad or mm.
constexpr double kJointTolerance = 1e-6;

std::vector<std::string> zone_names()
{
    std::vector<std::string> names;
    for (const Zone& zone : zones()) names.push_back(zone.name);
    return names;
}

} // namespace

ProgramArguments::ProgramArguments(cli::Tool& tool)
    : rapid(tool.optional_output("--rapid", "Write an ABB RAPID module; like all programs it needs --feed", {"mod"})),
      krl(tool.optional_output("--krl", "Write a KUKA KRL program", {"src"})),
      fanuc(
          tool.optional_output("--ls", "Write a Fanuc LS program, and beside it NAME_1.ls, …, which it calls", {"ls"})),
      urscript(tool.optional_output("--urscript", "Write a Universal Robots URScript program", {"script"})),
      unchecked(tool.flag("--unchecked", "Write programs of a path that fettle-collide has not checked, too; their "
                                         "first line says so")),
      zone(tool.choice("--zone", "z0", zone_names(),
                       "Programs: how near the tip must come to a target, as in RAPID "
                       "(0, 0.3, 1, 5, 10 mm)")),
      joint_speed(tool.number("--joint-speed", 20, "%", "Programs: of moves by joints, of the robot's own",
                              core::Range::between(1, 100))),
      output(tool.count("--process-output", 1, "Programs: digital output of the spindle or belt", 0, 65535)),
      force(tool.optional_number("--force", "N",
                                 "Programs: press with it on the strokes, by the robot's force control "
                                 "where the language has it [by position]",
                                 core::Range::positive())),
      coupling(tool.choice("--coupling", "file", {"file", "serial", "parallelogram"},
                           "RAPID of a URDF, which does not say it: the controller counts joint 3 from the upper arm, "
                           "or from the horizontal, as of ABB's arms with a parallelogram"))
{
}

std::string ProgramArguments::name_of_first() const
{
    for (const std::string* file : {&rapid, &krl, &fanuc, &urscript})
        if (!file->empty()) return *file;
    return "";
}

std::string ProgramArguments::option_of_first() const
{
    return !rapid.empty() ? "--rapid" : !krl.empty() ? "--krl" : !fanuc.empty() ? "--ls" : "--urscript";
}

std::string check_remark(const robot::Robot& robot, const cloud::Cloud& path, const robot::SolvedPath& solved,
                         bool may_be_unchecked, double mm)
try {
    const robot::PathStamp stamp = robot::read_stamp(robot, path, mm);
    const robot::CellJointsPath checked = robot::path_joints(path, robot);
    for (Eigen::Index i = 0; i < checked.cols(); ++i)
        for (Eigen::Index k = 0; k < 8; ++k) {
            const double found = solved.path.joints(k, i), unit = k == 6 ? 1 : core::kRadPerDegree;
            if (std::abs(found - checked(k, i)) > kJointTolerance)
                throw core::InputError("pose " + std::to_string(i) + ": joint " + std::to_string(k + 1) + " is at " +
                                       core::to_short_text(found / unit) + ", and was checked at " +
                                       core::to_short_text(checked(k, i) / unit));
        }
    return "checked: clearance " + core::to_short_text(stamp.clearance) + " mm, between poses " +
           core::to_short_text(stamp.between) + " mm" +
           (stamp.strokes ? ", from stroke to stroke " + core::to_short_text(*stamp.strokes) + " mm" : "") + ", part " +
           stamp.part + ", path " + stamp.digest.substr(0, 16);
} catch (const core::InputError& error) {
    if (!may_be_unchecked)
        throw core::InputError(std::string(error.what()) + "; --unchecked writes the program all the same");
    return "UNCHECKED for collisions";
}

void write_programs(cli::Tool& tool, const ProgramArguments& arguments, const robot::Robot& robot,
                    const cloud::Cloud& path, const robot::SolvedPath& solved, ProgramOptions options)
{
    options.zone = *std::ranges::find(zones(), arguments.zone, &Zone::name);
    options.joint_speed = arguments.joint_speed;
    options.process_output = arguments.output;
    options.force = arguments.force;
    if (arguments.coupling != "file")
        options.coupling = arguments.coupling == "serial" ? robot::Coupling::serial : robot::Coupling::parallelogram;
    if (!arguments.rapid.empty() && robot.controller && !options.coupling)
        throw core::InputError("--rapid of a URDF needs --coupling serial or parallelogram: whether the controller "
                               "counts joint 3 from the upper arm or from the horizontal");
    if (options.coupling && !robot.controller)
        throw core::InputError("--coupling goes with a URDF: a robot file says it");
    const Program program = make_program(robot, path, solved, options);
    if (!arguments.rapid.empty()) tool.output_file(arguments.rapid) << rapid_text(program);
    if (!arguments.krl.empty()) tool.output_file(arguments.krl) << krl_text(program, program_name(arguments.krl));
    if (!arguments.urscript.empty())
        tool.output_file(arguments.urscript) << urscript_text(program, program_name(arguments.urscript));
    if (arguments.fanuc.empty()) return;
    const std::filesystem::path first = arguments.fanuc;
    const bool is_device = std::filesystem::exists(first) && !std::filesystem::is_regular_file(first); // it takes all
    const std::vector<ProgramFile> files = fanuc_files(program, program_name(arguments.fanuc));
    tool.output_file(arguments.fanuc) << files.front().text;
    for (std::size_t k = 1; k < files.size(); ++k)
        tool.output_file(is_device ? arguments.fanuc : (first.parent_path() / files[k].name).string()) << files[k].text;
}

} // namespace fettle::program
