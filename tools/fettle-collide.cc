#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/constants.h"
#include "core/direction.h"
#include "core/file.h"
#include "mesh/mesh_file.h"
#include "robot/arm_report.h"
#include "robot/avoid_report.h"
#include "robot/cell_picture.h"
#include "robot/collision_report.h"
#include "robot/path_cloud.h"
#include "robot/solve_path.h"

using namespace fettle;

namespace {

// With the file's name before what the library has against it, but for options, which name themselves.
SolvedPath path_in(const Robot& robot, const std::string& file, const Cloud& cloud, const PathWishes& wishes, double mm)
{
    try {
        return has_field(cloud, "joint1") ? given_path(robot, cloud, wishes.jump_deg)
                                          : solve_path(robot, cloud, wishes, mm);
    } catch (const InputError& error) {
        if (std::string(error.what()).starts_with("--")) throw;
        throw InputError(display_name(file), error.what());
    }
}

// Numbers with commas between, or the pose of the least clearance.
std::vector<std::size_t> poses_in(const std::string& text, const CheckedPath& checked)
{
    if (text.empty()) {
        const Eigen::Index least = least_of(checked.pose);
        if (least < 0) throw InputError("--picture", "no pose is reached");
        return {static_cast<std::size_t>(least)};
    }
    std::vector<std::size_t> poses;
    for (const double number : numbers_in(text)) {
        if (!(number >= 0 && number < 1e9 && number == std::floor(number)))
            throw InputError("--at", "expected whole numbers with commas between, got '" + text + "'");
        poses.push_back(static_cast<std::size_t>(number));
    }
    return poses;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Collisions of a robot along a path: arm, tool, fixtures and workpiece, at the poses and between them.\n"
        "Signed clearances of the solids of the robot file among each other and against every triangle of the "
        "workpiece: "
        "negative is how far two solids must shift to come apart, or how deep the workpiece lies in one. Bodies on one "
        "link or on neighbouring links and allowed "
        "pairs are left out. A contact no deeper than the tolerance is no collision. PATH holds poses (as for "
        "fettle-arm "
        "--inverse, whose joints are found here) or joints. Added: clearance of the pose, clearance_between (on the "
        "way "
        "from the pose before, a lower bound), body and other (who: numbers in the robot file from 0, the workpiece's "
        "after the last), foot_x foot_y foot_z (where, in the cell). Exit 1 if something collides, a pose is not "
        "reached "
        "or the path jumps.\n"
        "With --avoid such poses are tilted about the centre of the ball at the tip, so that the point of contact "
        "stays "
        "(about the tip if there is no ball), on cones 5 degrees apart up to --most-tilt, the first that is clear and "
        "reached without a jump; where that does not help, the tool draws back by steps of 0.1 mm, along the normal if "
        "the path has normals, else along its axis. smooth finds the tilts of all poses together, so that they change "
        "as little as possible from pose to pose. Track and table stay. Added: avoided, tilt, tilt_towards, retreat; "
        "then all else is about the changed path.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& robot_file = t.file("ROBOT", "The robot, JSON");
        const std::string& points = t.input("PATH", "path or joints, PCD");
        const std::string& part = t.other_file("--workpiece", "MESH", "STL, PLY, OBJ, OFF, in the part's frame [none]");
        const auto& part_unit = t.length_unit("--workpiece-units", "Unit of that file, if it is not the path's");
        const auto& unit = t.length_unit("--file-units", "Unit of PATH, and of lengths here [its header, or mm]");
        const auto& tolerance = t.number_if_given("--tolerance", "LENGTH", "What goes no deeper is a contact [0.01 mm]",
                                                  Range::at_least(0));
        const auto& beyond =
            t.number_if_given("--beyond", "LENGTH", "Clearances are told up to here [50 mm]", Range::positive());
        const auto& resolution = t.number_if_given(
            "--resolution", "LENGTH",
            "Between poses, where bodies are near, they move no farther from look to look [0.1 mm]", Range::positive());
        PathWishes wishes;
        const std::string& track = t.text("--track", wishes.track, "RULE", "As of fettle-arm");
        const std::string& table = t.text("--table", wishes.table, "RULE", "As of fettle-arm");
        const std::string& start = t.text("--start", wishes.start, "DEG,…", "As of fettle-arm");
        const double& jump = t.number("--jump", wishes.jump_deg, "DEG", "As of fettle-arm", Range::positive());
        const auto& avoiding = t.choice_if_given("--avoid", {"pose", "smooth"},
                                                 "Lead the path around collisions, pose by pose or smoothly [pose]");
        AvoidOptions avoidance;
        const double& most_tilt =
            t.number("--most-tilt", 45, "DEG", "With --avoid: the tool leans no farther", Range::between(0, 90));
        const auto& most_retreat = t.number_if_given(
            "--most-retreat", "LENGTH", "With --avoid: it draws back no farther [1 mm]", Range::at_least(0));
        const std::string& method =
            t.choice("--method", "exact", {"exact", "grid", "paper"},
                     "Workpiece as all triangles; as those under the tool, elsewhere cuboids over a grid; or so by the "
                     "formulas that Chen & Wei print");
        const bool& exact = t.flag("--exact", "All triangles, everywhere: --method exact");
        const auto& cell = t.number_if_given("--cell", "LENGTH", "Of grids: side of a cell [1 mm]", Range::positive());
        const auto& picture =
            t.other_output("--picture", "Draw the cell at some poses, PNG; the workpiece as --method sees it");
        const auto& at = t.text("--at", "", "N,…", "Numbers of these poses, from 0 [that of the least clearance]");
        const auto& from = t.text("--from", "1,-1,0.8", "X,Y,Z", "Of the picture: towards the eye, in the cell");
        const auto& chart = t.other_output("--chart", "Draw the clearances along the path, PNG");
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-part parts/keel.json | fettle-collide robots/irb1400.json paths/keel.pcd --workpiece - "
                  "--report clear.json > checked.pcd",
                  "does the robot touch anything but the keel along which its ball runs?");
        t.reference("Chen & Wei, 4, 5 and algorithm 1; Gilbert, Johnson & Keerthi 1988; van den Bergen 2001");
        t.parse();

        wishes = {track, table, start, jump};
        const Robot robot = read_robot(robot_file);
        CloudFile file = read_cloud(points, unit ? std::optional(Units{*unit, Units::Force::N}) : std::nullopt);
        Cloud& cloud = file.cloud;
        const double mm = file.units.mm();
        CollisionOptions options;
        if (tolerance) options.tolerance = *tolerance * mm;
        if (beyond) options.beyond = *beyond * mm;
        if (resolution) options.resolution = *resolution * mm;
        avoidance = {avoiding == "smooth", most_tilt * kRadPerDegree, most_retreat.value_or(1 / mm) * mm,
                     jump * kRadPerDegree};
        SolvedPath solved = path_in(robot, points, cloud, wishes, mm);
        Mesh mesh;
        std::optional<Workpiece> workpiece;
        if (!part.empty()) {
            mesh = read_mesh(part, part_unit.value_or(file.units.length));
            workpiece.emplace(mesh);
            if (!workpiece->closed())
                t.warn(display_name(part) + ": is not closed: a body wholly inside it would not be noticed");
        }
        const Workpiece* const part_or_none = workpiece ? &*workpiece : nullptr;
        std::optional<Heterogeneous> model;
        if (exact && method != "exact") throw InputError("--exact: and --method " + method + ": one of them");
        if (method != "exact") {
            if (!workpiece) throw InputError("--method: " + method + " needs a --workpiece");
            model.emplace(*workpiece, tool_directions(solved.poses),
                          HeterogeneousOptions{cell.value_or(1 / mm) * mm,
                                               method == "paper" ? Formulas::published : Formulas::right,
                                               options.tolerance});
            options.model = &*model;
        }
        CheckedPath checked = check_path(robot, part_or_none, solved.path.joints, options, t.progress("poses"));
        const CheckedPath before = checked;
        std::optional<AvoidedPath> avoided;
        if (!avoiding.empty()) {
            avoided = avoid(robot, part_or_none, solved, checked, retreat_directions(cloud, solved.poses), avoidance,
                            options);
            add_report(t.report(), robot, *avoided, checked, avoidance, options, file.units);
            solved.poses = avoided->poses;
            solved.path = avoided->path;
            checked = avoided->checked;
        }
        set_path(cloud, solved.poses);
        set_joints(cloud, robot, solved.path.joints);
        set_states(cloud, solved.path);
        set_clearances(cloud, robot, checked);
        if (avoided) set_changes(cloud, *avoided, options.tolerance);
        if (!picture.empty()) {
            const CellPictureOptions look = {poses_in(at, checked), parse_direction(from, "--from"), options.tolerance,
                                             file.units, model ? &*model : nullptr};
            t.output_file(picture) << cell_picture(robot, workpiece ? &mesh : nullptr, solved.path.joints, checked,
                                                   look);
        }
        if (!chart.empty())
            t.output_file(chart) << clearance_chart(checked, avoided ? &before : nullptr,
                                                    avoided ? &avoided->changes : nullptr, file.units);
        std::optional<Eigen::VectorXd> times;
        if (has_field(cloud, "t")) times = field(cloud, "t");
        const bool run = add_report(t.report(), robot, solved.path, 0, times, file.units);
        const bool clear = add_report(t.report(), robot, checked, options, times, file.units);
        write_pcd(t.output(), cloud, file.units, ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        return run && clear ? Verdict::yes : Verdict::no;
    });
}
