#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/constants.h"
#include "core/file.h"
#include "mesh/shape_file.h"
#include "robot/arm_report.h"
#include "robot/path_cloud.h"
#include "robot/path_options.h"
#include "robot/rapid.h"
#include "robot/reach.h"

#include <optional>

using namespace fettle;

namespace {

const std::string kDescription =
    "Kinematics of a robot along a path: joints to tool poses (--forward), or tool poses to joints (--inverse), in "
    "closed form; or the reach of a robot (--reach).\n"
    "Of all solutions in range, whole turns included, --inverse takes those with the fewest jumps and, of these, the "
    "least motion. Points: x y z is the tip, qw qx qy qz turns the tool's frame (+z from the tip to the holder, +x "
    "along the feed) to the part's; joint1 to joint6 in degrees, joint7 the track, joint8 the table in degrees. Added: "
    "state (0 reached, 1 unreachable, 2 out of range, 3 undefined) and singularity, the distance from one. Exit 1 "
    "if a pose is not reached, the path jumps or a joint is too fast.";

struct Options {
    cli::Tool& t;
    const std::string& robot = t.positional_file("ROBOT", "The robot, JSON");
    const std::string& points = t.main_input("POINTS", "joints or path, PCD");
    const bool& to_poses = t.flag("--forward", "From joints to poses");
    const bool& to_joints = t.flag("--inverse", "From poses to joints");
    const bool& reach = t.flag("--reach", "No path: cells of --box, in the field reach the fraction of 26 directions "
                                          "that the tool can have with its tip there, at any position of the track");
    const std::string& box = t.text("--box", "", "X0,Y0,Z0,X1,Y1,Z1", "Reach: minimum and maximum corner, cell frame");
    const double& step = t.number("--step", 100, "LENGTH", "Reach: side of the cells", core::Range::positive());
    const std::optional<units::Units::Length>& unit =
        t.length_unit("--file-units", "Unit of POINTS, and of lengths here [its header, or mm]");
    robot::PathOptions path{t};
    const double& singular =
        t.number("--singular", 0.05, "D",
                 "Poses nearer to a singularity are counted. The distance is the minimum of the sines of joint 5 and "
                 "of the elbow, and the distance of the wrist centre from axis 1 over the reach",
                 core::Range::between(0, 1));
    const std::optional<double>& feed = t.optional_number(
        "--feed", "LENGTH/S", "Speed of the tip, for speeds and accelerations of the joints [the field t]",
        core::Range::positive());
    const double& turn_feed =
        t.number("--turn-feed", 500, "DEG/S", "Maximum turn rate of the tool", core::Range::positive());
    const bool& all = t.flag("--all", "Write every solution of each pose: a point each, with pose and branch");
    const std::string& rapid = t.optional_output("--rapid", "Write an ABB RAPID module, too; it needs --feed");
    const std::string& zone = t.choice("--zone", "z0", {"fine", "z0", "z1", "z5", "z10"}, "RAPID: of the targets");
    const bool& ascii = t.flag("--ascii", "Text instead of binary");
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-arm robots/irb1400.json --inverse paths/keel.pcd --feed 50 --rapid keel.mod > joints.pcd",
              "joints along the keel of a hull, and the robot's program");
    t.reference("Chen & Wei, eq. 1 and 2, table 1; Pieper 1968 (closed form)");
}

void check(const Options& o)
{
    if (int(o.to_poses) + int(o.to_joints) + int(o.reach) != 1)
        throw core::InputError("give one of --forward, --inverse and --reach");
    if (o.all && o.to_poses) throw core::InputError("--all goes with --inverse");
    if (!o.rapid.empty() && !o.feed) throw core::InputError("--rapid needs --feed");
    if (!o.rapid.empty() && o.reach) throw core::InputError("--rapid needs a path");
    if (!o.box.empty() && !o.reach) throw core::InputError("--box goes with --reach");
}

cli::Verdict study_reach(const Options& o, const robot::Robot& robot)
{
    const units::Units units{o.unit.value_or(units::Units::Length::mm), units::Units::Force::N};
    const Eigen::AlignedBox3d box = robot::parse_reach_box(o.box, units.mm());
    const robot::ReachStudy study = robot::compute_reach(robot, box, o.step * units.mm(), o.t.progress("reach"));
    o.t.report() = to_json(study);
    cloud::write_pcd(o.t.output(), to_cloud(study), units, cloud::pcd_encoding(o.ascii));
    return cli::Verdict::yes;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        check(o);

        const robot::Robot robot = robot::read_robot(o.robot);
        if (o.reach) return study_reach(o, robot);
        cloud::CloudFile file = cloud::read_cloud(o.points, mesh::resolve_file_units(o.unit));
        cloud::Cloud& cloud = file.cloud;
        const double mm = file.units.mm();
        const robot::SolvedPath solved = cli::with_error_prefix(core::display_name(o.points), [&] {
            return o.to_poses ? robot::path_from_joints(robot, cloud, o.path.jump)
                              : robot::path_from_poses(robot, cloud, o.path.arguments(), mm);
        });

        const cloud::PcdEncoding encoding = cloud::pcd_encoding(o.ascii);
        if (o.all) cloud::write_pcd(t.output(), robot::all_solutions(robot, cloud, solved), file.units, encoding);
        if (o.to_poses) cloud::set_poses(cloud, solved.poses);
        if (o.to_joints) robot::set_joints(cloud, robot, solved.path.joints);
        const robot::Feedrate feedrate = {o.feed.value_or(0) * mm, o.turn_feed * core::kRadPerDegree};
        if (o.feed) cloud::set_field(cloud, "t", robot::arrival_times(solved.poses, feedrate), 8);
        robot::set_states(cloud, solved.path);
        if (!o.all) cloud::write_pcd(t.output(), cloud, file.units, encoding);

        if (o.to_joints) robot::add_report(t.report(), robot, solved.externals, file.units);
        const auto times = robot::pose_times(cloud);
        const bool done = robot::add_report(t.report(), robot, solved.path, o.singular, times, file.units);
        if (done && !o.rapid.empty())
            robot::write_rapid(t.output_file(o.rapid), robot, solved.poses, solved.path, {feedrate, o.zone});
        if (!done && !o.rapid.empty())
            t.warn("the robot cannot run this path: " + robot::path_obstacle(robot, solved.path, times) + "; " +
                   o.rapid + " is not written");
        return done ? cli::Verdict::yes : cli::Verdict::no;
    });
}
