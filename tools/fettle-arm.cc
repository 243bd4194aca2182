#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "cloud/poses.h"
#include "core/constants.h"
#include "core/file.h"
#include "core/text.h"
#include "mesh/shape_file.h"
#include "program/program_options.h"
#include "robot/arm_report.h"
#include "robot/path_cloud.h"
#include "robot/path_options.h"
#include "robot/rates.h"
#include "robot/reach.h"

#include <cmath>
#include <optional>
#include <vector>

using namespace fettle;

namespace {

const std::string kDescription =
    "Compute the kinematics of a robot along a path: joints to tool poses (--forward), or tool poses to joints "
    "(--inverse), in closed form; or the reach of a robot (--reach).\n"
    "Points: x y z is the tip, qw qx qy qz turns the tool's frame (+z from the tip to the holder, +x along the feed) "
    "to the part's; joint1 to joint6 in degrees, joint7 the track, joint8 the table in degrees. Of all solutions in "
    "range, whole turns included, --inverse takes those with the fewest jumps and, of these, the least motion.\n"
    "Added: state (0 reached, 1 unreachable, 2 out of range, 3 undefined) and singularity, the distance from one. "
    "Exit 1 if a pose is not reached, the path jumps or a joint is too fast.\n"
    "Robot programs are written of paths only that fettle-collide has checked, with the joints that it has checked: to "
    "the first pose by joints, on straight from pose to pose; a part of its own for each value of the field anomaly, "
    "called one after the other; feeds from the field feed, where it has a value, else --feed.";

struct Options {
    cli::Tool& t;
    robot::RobotOptions robot{t};
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
        "--feed", "LENGTH/S", "Speed of the tip on the part, for speeds and accelerations of the joints [the field t]",
        core::Range::positive());
    const std::optional<double>& travel = t.optional_number(
        "--travel-feed", "LENGTH/S", "Its speed from stroke to stroke [250 mm/s]", core::Range::positive());
    const double& turn_feed =
        t.number("--turn-feed", 500, "DEG/S", "Maximum turn rate of the tool", core::Range::positive());
    const bool& all = t.flag("--all", "Write every solution of each pose: a point each, with pose and branch");
    program::ProgramArguments program{t};
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-part parts/keel.json | fettle-collide robots/irb1400.json paths/keel.pcd --workpiece - | "
              "fettle-arm robots/irb1400.json --inverse - --feed 50 --rapid keel.mod > joints.pcd",
              "joints along the keel of a hull, checked, and the robot's program");
    t.reference("Chen & Wei, eq. 1 and 2, table 1; Pieper 1968 (closed form)");
}

void check(const Options& o)
{
    if (int(o.to_poses) + int(o.to_joints) + int(o.reach) != 1)
        throw core::InputError("give one of --forward, --inverse and --reach");
    if (o.all && o.to_poses) throw core::InputError("--all goes with --inverse");
    if (o.program.any() && o.reach) throw core::InputError(o.program.option_of_first() + " needs a path");
    if (o.program.any() && !o.feed) throw core::InputError(o.program.option_of_first() + " needs --feed");
    if (o.program.any() && o.all) throw core::InputError(o.program.option_of_first() + " and --all do not go together");
    if (!o.box.empty() && !o.reach) throw core::InputError("--box goes with --reach");
}

cli::Verdict study_reach(const Options& o, const robot::Robot& robot)
{
    const units::Units units{o.unit.value_or(units::Units::Length::mm), units::Units::Force::N};
    const Eigen::AlignedBox3d box = robot::parse_reach_box(o.box, units.mm());
    const robot::ReachStudy study = robot::compute_reach(robot, box, o.step * units.mm(), o.t.progress("reach"));
    o.t.report() = to_json(study);
    o.out.write(to_cloud(study), units);
    return cli::Verdict::yes;
}

/// Speed of the motion to each pose, mm/s: the field feed on the part, else --feed; --travel-feed off it.
Eigen::VectorXd speeds_along(const Options& o, const cloud::Cloud& path, double mm)
{
    constexpr double kTravelSpeed = 250; // mm/s: a robot's reduced speed in manual mode (ISO 10218-1)
    const std::vector<cloud::Motion> motions = cloud::read_motions(path);
    Eigen::VectorXd speeds = Eigen::VectorXd::Constant(path.size(), *o.feed * mm);
    if (cloud::has_field(path, "feed")) {
        const Eigen::VectorXd feeds = cloud::field(path, "feed");
        for (Eigen::Index i = 0; i < feeds.size(); ++i)
            if (feeds[i] > 0) speeds[i] = feeds[i];
    }
    for (std::size_t i = 0; i < motions.size(); ++i)
        if (motions[i] >= cloud::Motion::lead) speeds[i] = o.travel ? *o.travel * mm : kTravelSpeed;
    return speeds;
}

/// Way to each pose that the feed is along, mm: the field way of a part in the robot's hand, while it is on the wheel;
/// else the tip's.
Eigen::VectorXd ways_along(const cloud::Cloud& path, const cloud::PosePath& poses)
{
    Eigen::VectorXd ways = robot::tip_ways(poses);
    if (!cloud::has_field(path, "way")) return ways;
    const Eigen::VectorXd contact = cloud::field(path, "way");
    const std::vector<cloud::Motion> motions = cloud::read_motions(path);
    for (Eigen::Index i = 1; i < ways.size(); ++i)
        if (motions[i] < cloud::Motion::lead && !std::isnan(ways[i])) ways[i] = contact[i] - contact[i - 1];
    return ways;
}

/// Speeds of the tip at which it takes the times given, mm/s; programs state no other.
Eigen::VectorXd tip_speeds(const cloud::PosePath& poses, const Eigen::VectorXd& ways, const Eigen::VectorXd& speeds)
{
    // Where the part turns about its frame's origin, the tip rests and its speed says nothing.
    constexpr double kMinShare = 0.01;
    const Eigen::VectorXd of_tip = robot::tip_ways(poses);
    Eigen::VectorXd result = speeds;
    for (Eigen::Index i = 1; i < ways.size(); ++i) {
        if (!(ways[i] > 0) || of_tip[i] == ways[i]) continue;
        if (of_tip[i] < kMinShare * ways[i])
            throw core::InputError("pose " + std::to_string(i) + ": the contact moves " + core::to_short_text(ways[i]) +
                                   " mm along the part, but the part's frame only " + core::to_short_text(of_tip[i]) +
                                   " mm: no speed of a program holds the feed there; put the tool frame elsewhere");
        result[i] *= of_tip[i] / ways[i];
    }
    return result;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        check(o);

        const robot::Robot robot = o.robot.read();
        if (o.reach) return study_reach(o, robot);
        cloud::CloudFile file = cloud::read_cloud(o.points, mesh::resolve_file_units(o.unit));
        cloud::Cloud& cloud = file.cloud;
        const double mm = file.units.mm();
        const robot::SolvedPath solved = cli::with_error_prefix(core::display_name(o.points), [&] {
            return o.to_poses ? robot::path_from_joints(robot, cloud, o.path.jump)
                              : robot::path_from_poses(robot, cloud, o.path.arguments(), mm);
        });

        const cloud::Cloud given = cloud;
        if (o.all) o.out.write(robot::all_solutions(robot, cloud, solved), file.units);
        if (o.to_poses) cloud::set_poses(cloud, solved.poses);
        if (o.to_joints) robot::set_joints(cloud, robot, solved.path.joints);
        program::ProgramOptions options;
        options.turn_rate = o.turn_feed * core::kRadPerDegree;
        if (o.feed) {
            options.speeds = speeds_along(o, cloud, mm);
            const Eigen::VectorXd ways = ways_along(cloud, solved.poses);
            cloud::set_field(cloud, "t", robot::arrival_times(solved.poses, ways, options.speeds, options.turn_rate),
                             8);
            if (o.program.any())
                options.speeds = cli::with_error_prefix(core::display_name(o.points),
                                                        [&] { return tip_speeds(solved.poses, ways, options.speeds); });
        }
        robot::set_states(cloud, solved.path);
        if (!o.all) o.out.write(cloud, file.units);

        if (o.to_joints) robot::add_report(t.report(), robot, solved.externals, file.units);
        const auto times = robot::pose_times(cloud);
        const bool done = robot::add_report(t.report(), robot, solved.path, o.singular, times, file.units);
        if (done && o.program.any()) {
            options.remark = cli::with_error_prefix(core::display_name(o.points), [&] {
                return program::check_remark(robot, given, solved, o.program.unchecked, mm);
            });
            program::write_programs(t, o.program, robot, given, solved, options);
        }
        if (!done && o.program.any())
            t.warn("the robot cannot run this path: " + robot::path_obstacle(robot, solved.path, times) + "; " +
                   o.program.name_of_first() + " is not written");
        return done ? cli::Verdict::yes : cli::Verdict::no;
    });
}
