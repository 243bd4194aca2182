#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/constants.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/arm_report.h"
#include "robot/path_cloud.h"
#include "robot/rapid.h"
#include "robot/reach.h"
#include "robot/solve_path.h"

using namespace fettle;

namespace {

Eigen::AlignedBox3d box_in(const std::string& text, double mm)
{
    const Eigen::VectorXd corners = numbers_in(text) * mm;
    if (corners.size() != 6 || !corners.allFinite() || (corners.tail<3>() - corners.head<3>()).minCoeff() < 0)
        throw InputError("--box", "expected x,y,z of its least and of its greatest corner, got " + in_quotes(text));
    return {corners.head<3>(), corners.tail<3>()};
}

// The cells of a box, with the share of directions in which the tool reaches them.
void write_reach(Tool& t, const Robot& robot, const std::string& box, double step, const Units& units,
                 PcdEncoding encoding)
{
    const double mm = units.mm();
    const ReachStudy study = study_reach(robot, box_in(box, mm), step * mm, t.progress("reach"));
    Cloud cloud;
    cloud.xyz = study.tips;
    set_field(cloud, "reach", study.share);
    t.report()
        .set("cells", static_cast<std::size_t>(study.share.size()))
        .set("reached", (study.share.array() > 0).cast<double>().mean())
        .set("reached_from_all_sides", (study.share.array() == 1).cast<double>().mean())
        .set("mean_reach", study.share.mean());
    write_pcd(t.output(), cloud, units, encoding);
}

// Every solution of every pose, a point each: fields pose and branch.
void write_all(Tool& t, const Cloud& cloud, const Robot& robot, const SolvedPath& solved, const Units& units,
               PcdEncoding encoding)
{
    const PosePath& poses = solved.poses;
    std::vector<Eigen::Index> from;
    std::vector<double> branches;
    std::vector<CellJoints> solutions;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (poses[i].translation().hasNaN()) continue;
        const Eigen::Vector2d external = solved.external_values.col(static_cast<Eigen::Index>(i));
        for (const auto& [branch, joints] :
             all_solutions(robot, flange_for(robot, poses[i], external[0], external[1]))) {
            from.push_back(static_cast<Eigen::Index>(i));
            branches.push_back(branch);
            solutions.emplace_back() << joints, external;
        }
    }
    Cloud all = select(cloud, from);
    const auto count = static_cast<Eigen::Index>(from.size());
    CellJointsPath joints(8, count);
    for (Eigen::Index i = 0; i < count; ++i) joints.col(i) = solutions[static_cast<std::size_t>(i)];
    set_joints(all, robot, joints);
    set_field(all, "pose",
              Eigen::Map<Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1>>(from.data(), count).cast<double>());
    set_field(all, "branch", Eigen::Map<Eigen::VectorXd>(branches.data(), count));
    write_pcd(t.output(), all, units, encoding);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Kinematics of a robot along a path: joints to tool poses (--forward), or tool poses to joints (--inverse), in "
        "closed form; or where a robot reaches (--reach).\n"
        "Of all solutions in range, whole turns included, --inverse takes the way with the fewest jumps and the least "
        "motion. Points: x y z is the tip, qw qx qy qz turns the tool's frame (+z from the tip to the holder, +x along "
        "the feed) to the part's; joint1 to joint6 in degrees, joint7 the track, joint8 the table in degrees. Added: "
        "state (0 reached, 1 unreachable, 2 out of range, 3 undefined) and singularity, the distance from one. Exit 1 "
        "if a pose is not reached, the path jumps or a joint is too fast.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& robot_file = t.file("ROBOT", "The robot, JSON");
        const std::string& points = t.input("POINTS", "joints or path, PCD");
        const bool& to_pose = t.flag("--forward", "From joints to poses");
        const bool& to_joints = t.flag("--inverse", "From poses to joints");
        const bool& reach =
            t.flag("--reach", "No path: cells of --box, in the field reach the share of 26 directions of "
                              "the tool in which its tip can be there, with any place of the track");
        const std::string& box =
            t.text("--box", "", "X0,Y0,Z0,X1,Y1,Z1", "Reach: least and greatest corner, cell frame");
        const double& step = t.number("--step", 100, "LENGTH", "Reach: side of the cells", Range::positive());
        const auto& unit = t.length_unit("--file-units", "Unit of POINTS, and of lengths here [its header, or mm]");
        const std::string& track = t.text(
            "--track", "auto", "RULE",
            "The track stands at a place (LENGTH), or follows the tip (follow:LENGTH behind it along the track); "
            "auto: the rule under which all of the path is reached farthest from singularities, standing still "
            "if that will do");
        const std::string& table =
            t.text("--table", "auto", "RULE", "The table: DEG, follow:DEG (the tip's azimuth about its axis) or auto");
        const std::string& start = t.text("--start", "0,0,0,0,0,0", "DEG,…", "The path begins nearest to these joints");
        const double& jump = t.number("--jump", 30, "DEG", "More between two poses is a jump", Range::positive());
        const double& singular = t.number("--singular", 0.05, "D",
                                          "Poses nearer to a singularity are counted: the least of the sines of "
                                          "joint 5 and of the elbow, and the wrist centre's share of the reach",
                                          Range::between(0, 1));
        const auto& feed = t.number_if_given("--feed", "LENGTH/S",
                                             "Of the tip, for speeds and accelerations of the joints [the field t]",
                                             Range::positive());
        const double& turn_feed = t.number("--turn-feed", 500, "DEG/S", "The tool turns no faster", Range::positive());
        const bool& all = t.flag("--all", "Write every solution of each pose: a point each, with pose and branch");
        const std::string& rapid = t.other_output("--rapid", "Write an ABB RAPID module, too; it needs --feed");
        const std::string& zone = t.choice("--zone", "z0", {"fine", "z0", "z1", "z5", "z10"}, "RAPID: of the targets");
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-arm robots/irb1400.json --inverse paths/keel.pcd --feed 50 --rapid keel.mod > joints.pcd",
                  "joints along the keel of a hull, and the robot's program");
        t.reference("Chen & Wei, eq. 1 and 2, table 1; Pieper 1968 (closed form)");
        t.parse();

        if (int(to_pose) + int(to_joints) + int(reach) != 1)
            throw InputError("give one of --forward, --inverse and --reach");
        if (all && to_pose) throw InputError("--all goes with --inverse");
        if (!rapid.empty() && !feed) throw InputError("--rapid needs --feed");
        if (!rapid.empty() && reach) throw InputError("--rapid needs a path");
        if (!box.empty() && !reach) throw InputError("--box goes with --reach");
        const Robot robot = read_robot(robot_file);
        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        if (reach) {
            write_reach(t, robot, box, step, Units{unit.value_or(Units::Length::mm), Units::Force::N}, encoding);
            return Verdict::yes;
        }
        CloudFile file = read_cloud(points, unit ? std::optional(Units{*unit, Units::Force::N}) : std::nullopt);
        Cloud& cloud = file.cloud;
        const double mm = file.units.mm();
        const PathWishes wishes = {track, table, start, jump};
        const SolvedPath solved = named(display_name(points), [&] {
            return to_pose ? given_path(robot, cloud, jump) : solve_path(robot, cloud, wishes, mm);
        });
        const FollowedPath& path = solved.path;
        if (to_pose) {
            set_path(cloud, solved.poses);
        } else {
            if (robot.track) t.report().set("track", to_json(solved.externals.track, mm));
            if (robot.table) t.report().set("table", to_json(solved.externals.table, kRadPerDegree));
            if (all) write_all(t, cloud, robot, solved, file.units, encoding);
            set_joints(cloud, robot, path.joints);
        }
        std::optional<Eigen::VectorXd> times;
        const Feedrate feedrate = {feed.value_or(0) * mm, turn_feed * kRadPerDegree};
        if (feed)
            set_field(cloud, "t", times.emplace(arrival_times(solved.poses, feedrate)), 8);
        else if (has_field(cloud, "t"))
            times = field(cloud, "t");
        set_states(cloud, path);
        if (!all) write_pcd(t.output(), cloud, file.units, encoding);
        const bool done = add_report(t.report(), robot, path, singular, times, file.units);
        if (done && !rapid.empty()) write_rapid(t.output_file(rapid), robot, solved.poses, path, {feedrate, zone});
        if (!done && !rapid.empty()) t.warn("the robot cannot run this path: " + rapid + " is not written");
        return done ? Verdict::yes : Verdict::no;
    });
}
