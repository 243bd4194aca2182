#include "carrier/robot_gantry.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/constants.h"
#include "core/descriptor.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "gantry/make_virtual.h"
#include "gantry/serve.h"
#include "job/frame.h"
#include "plan/plan.h"
#include "robot/arm_report.h"
#include "robot/path_options.h"

#include <ostream>
#include <unistd.h>

using namespace fettle;

namespace {

const std::string kDescription =
    "Drive a simulated robot in the place of a gantry, by the protocol of a real one.\n"
    "fettle-grind --place says where the part lies in the robot's cell. The wheel stands in the job's frame as on a "
    "gantry; the joints follow on one branch of the inverse kinematics, within their ranges and no faster than the "
    "robot's file allows. A plan that is not reached as a whole is refused before anything moves, with the place, the "
    "joint and its value, and so is one over which arm, head and fixtures hit each other; the part is for "
    "fettle-collide. Head, spring and stock are those of fettle-gantry-virtual.";

struct Options {
    cli::Tool& t;
    robot::RobotOptions robot{t};
    const std::string& plan = t.positional_file("PLAN", "The plan that will be ground, JSON");
    gantry::StockOptions stock{t};
    const double& removal_factor = gantry::declare_removal_factor(t);
    robot::PathOptions path{t};
    const std::string& ground = t.optional_output("--ground", "The ground part at the end", cloud::cloud_formats());
    const std::string& moves = t.optional_output(
        "--moves", "Where the robot was: poses in the cell, joints, times; for fettle-collide", cloud::cloud_formats());
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-gantry-robot robots/irb1400_wheel.json <(fettle-sample jobs/wang1.json | fettle-fit "
              "jobs/wang1.json | fettle-plan jobs/wang1.json) --stock <(fettle-part parts/wang1.json) "
              "<<< '1 frame 900 1000 600 1 0 0 0'",
              "does the robot reach Wang's part 1 there?");
    t.reference("docs/driver.md: the protocol");
}

/// What the joints did, as fettle-arm reports it.
void report_moves(cli::Tool& t, const robot::Robot& robot, const carrier::RobotGantry& gantry, double jump)
{
    const auto& moments = gantry.moments();
    const auto count = static_cast<Eigen::Index>(moments.size());
    if (count == 0) return;
    robot::CellJointsPath joints(8, count);
    Eigen::VectorXd times(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        joints.col(i) = moments[i].joints;
        times[i] = moments[i].time;
    }
    robot::add_report(t.report(), robot, gantry.arm()->externals(), units::Units{});
    constexpr double kSingular = 0.05; // as fettle-arm's --singular
    robot::add_report(t.report(), robot, robot::evaluate_joints(robot, joints, jump * core::kRadPerDegree), kSingular,
                      times, units::Units{});
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.disable_output();
        t.parse();

        const robot::Robot robot = o.robot.read();
        const plan::Plan plan = plan::read_plan(o.plan);
        const auto [stock, doubts, dropped] = gantry::read_stock(o.stock, plan.job, removal::Extent::anomaly);
        gantry::require_below_safe_height(stock, plan.job, core::display_name(o.stock.file));
        for (const std::string& doubt : doubts) t.warn(doubt);
        carrier::RobotGantry gantry(robot, o.path.arguments(), plan,
                                    gantry::make_virtual_gantry(stock, plan.job, {"", o.removal_factor, t.seed()}));
        gantry::serve(gantry, gantry.limits(), plan.job, core::FileDescriptor(::dup(STDIN_FILENO)),
                      core::FileDescriptor(::dup(STDOUT_FILENO)));
        if (!o.ground.empty())
            cloud::write_cloud(t, o.ground,
                               job::in_job_frame(removal::to_cloud(stock, gantry.head().stock()), plan.job),
                               plan.job.units);
        if (!o.moves.empty()) cloud::write_cloud(t, o.moves, to_cloud(robot, gantry.moments()), units::Units{});
        report_moves(t, robot, gantry, o.path.jump);
        return cli::Verdict::yes;
    });
}
