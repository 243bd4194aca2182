// A robot in the gantry's place: the way through a plan, joints along it, and what is refused.

#include "gantry_stock.h"
#include "irb1400.h"

#include "carrier/robot_gantry.h"
#include "carrier/work_points.h"
#include "gantry/quasi_static.h"
#include "plan/tool_path.h"

#include <gtest/gtest.h>

#include <memory>

namespace fettle {
namespace carrier_test {

struct Work {
    plan::Plan plan;
    removal::HeightField stock;
};

/// A tilted plane with metal of 4 mm upon it.
Work work()
{
    job::Job job = small_job();
    job.surface = job::SurfaceType::plane;
    job.theta = 0.4;
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(job.theta).transpose();
    job.anomaly = Eigen::Matrix3Xd::Zero(3, 4);
    job.anomaly.topRows(2) << -8, 8, 8, -8, -20, -20, 20, 20;
    job.anomaly.topRows(2) = (R_machine_working * job.anomaly.topRows(2)).eval();
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 6, {0.05, 0.02}};
    return {plan::make_plan(job, surface), stock([](double, double) { return kTop; }, 0.4, job.theta)};
}

Eigen::Isometry3d place(double x, double y, double z)
{
    Eigen::Isometry3d T(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 0.5).normalized()));
    T.pretranslate(Eigen::Vector3d(x, y, z));
    return T;
}

carrier::RobotGantry gantry_of(const robot::Robot& robot, const Work& of)
{
    return {robot, {}, of.plan, std::make_unique<gantry::QuasiStaticGantry>(of.stock, of.plan.job)};
}

TEST(WorkPoints, PassEveryToolPointOfThePlan)
{
    const auto [plan, stock] = work();
    const Eigen::Vector3d from(1, 2, 30);
    const std::vector<Eigen::Vector3d> points = carrier::work_points(plan, from, kTop);
    ASSERT_EQ(points.front(), from);
    for (std::size_t i = 1; i < points.size(); ++i)
        EXPECT_LE((points[i] - points[i - 1]).norm(), carrier::kWorkPointSpacing * (1 + 1e-12)) << i;
    const double depth = plan.job.force.max / plan.job.force.stiffness;
    const plan::ToolPath path(plan.job, plan.surface, plan.passes, plan.step);
    ASSERT_FALSE(path.passes().empty());
    for (const plan::ToolPass& pass : path.passes())
        for (const Eigen::Vector3d& point : pass.points)
            for (const double z : {point.z() - depth, kTop}) {
                const Eigen::Vector3d wanted(point.x(), point.y(), z);
                double nearest = INFINITY;
                for (const Eigen::Vector3d& at : points) nearest = std::min(nearest, (at - wanted).norm());
                EXPECT_LE(nearest, carrier::kWorkPointSpacing);
            }
}

TEST(ArmFollower, FollowsTheBestSequence)
{
    const robot::Robot robot = irb1400();
    const auto [plan, stock] = work();
    const std::vector<Eigen::Vector3d> points = carrier::work_points(plan, {0, 0, 30}, kTop);
    const carrier::ArmFollower arm(robot, {}, place(900, 100, 500), plan.job.theta, points);
    cloud::PosePath poses;
    for (const Eigen::Vector3d& point : points) poses.push_back(arm.pose_at(point));
    const robot::FollowedPath best =
        robot::follow_path(robot, poses, Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(poses.size())));
    ASSERT_TRUE(best.jumps.empty());
    robot::CellJoints joints = arm.start();
    for (std::size_t i = 0; i < points.size(); ++i) {
        joints = arm.joints_at(points[i], joints);
        EXPECT_LT((joints - best.joints.col(static_cast<Eigen::Index>(i))).norm(), 1e-9) << i;
        const Eigen::Isometry3d tool = robot::Arm(robot).flange(joints.head<6>()) * robot.T_flange_tool;
        EXPECT_LT((tool.matrix() - poses[i].matrix()).norm(), 1e-8) << i;
    }
    // The wheel, about the tool's y, has its axis at θ, and stands on the job's z.
    const Eigen::Matrix3d R_job_tool = place(900, 100, 500).linear().transpose() * poses.front().linear();
    EXPECT_NEAR(std::abs(R_job_tool.col(1).dot(Eigen::Vector3d(std::cos(0.4), std::sin(0.4), 0))), 1, 1e-12);
    EXPECT_NEAR(R_job_tool(2, 2), 1, 1e-12);
}

std::string refusal(const robot::Robot& robot, const Eigen::Isometry3d& T_cell_job)
{
    const Work of = work();
    carrier::RobotGantry gantry = gantry_of(robot, of);
    try {
        gantry.set_frame(T_cell_job);
    } catch (const gantry::GantryFault& fault) {
        EXPECT_TRUE(gantry.moments().empty());
        return fault.what();
    }
    return "";
}

TEST(RobotGantry, RefusesWhatIsNotReached)
{
    robot::Robot robot = irb1400();
    EXPECT_EQ(refusal(robot, place(900, 100, 500)), "");
    EXPECT_NE(refusal(robot, place(2900, 100, 500)).find("is out of the arm's reach: the flange would be "),
              std::string::npos);
    robot.dh[4].range = {-0.1, 0.1};
    const std::string limit = refusal(robot, place(900, 100, 500));
    EXPECT_EQ(limit.find("the pose at "), 0u) << limit;
    EXPECT_NE(limit.find("joint 5 would be at "), std::string::npos) << limit;
    EXPECT_NE(limit.find("out of its range of -5.7"), std::string::npos) << limit;
}

TEST(RobotGantry, RefusesWhatIsNotReachedLater)
{
    const robot::Robot robot = irb1400();
    const Work of = work();
    carrier::RobotGantry gantry = gantry_of(robot, of);
    EXPECT_THROW(gantry.lift(25), gantry::GantryFault); // where?
    gantry.set_frame(place(900, 100, 500));
    EXPECT_THROW(gantry.set_frame(place(900, 100, 500)), gantry::GantryFault);
    gantry.travel({0, 0, 20});
    const std::size_t moved = gantry.moments().size();
    const gantry::GantryStatus before = gantry.status();
    EXPECT_THROW(gantry.travel({0, 1500, 20}), gantry::GantryFault);
    EXPECT_THROW(gantry.grind({0, -1500, 20}, 20), gantry::GantryFault);
    EXPECT_EQ(gantry.moments().size(), moved);
    EXPECT_EQ(gantry.status().commanded, before.commanded);
    EXPECT_EQ(gantry.status().time, before.time);
    EXPECT_EQ(gantry.lift(25).commanded.z(), 25);
}

/// Where the last moment has the tool point is where the head says that it stands.
void expect_recorded(const carrier::RobotGantry& gantry, const Eigen::Isometry3d& T_cell_job)
{
    const Eigen::Vector3d there = T_cell_job * gantry.status().commanded;
    EXPECT_LT((gantry.moments().back().pose.translation() - there).norm(), 1e-6);
}

TEST(RobotGantry, RecordsADescentThatEndsEarlyAndAWheelThatIsChanged)
{
    const robot::Robot robot = irb1400();
    const Work of = work();
    carrier::RobotGantry gantry = gantry_of(robot, of);
    gantry.set_frame(place(900, 100, 500));
    gantry.travel({0, 0, kTop + 5});
    gantry.lift(kTop - 4); // guarded: the metal ends it
    EXPECT_GT(gantry.status().commanded.z(), kTop - 4);
    EXPECT_LT(gantry.status().commanded.z(), kTop + 5);
    expect_recorded(gantry, place(900, 100, 500));
    const std::size_t moved = gantry.moments().size();
    const double before = gantry.status().time;
    gantry.change_wheel();
    EXPECT_GT(gantry.moments().size(), moved);
    EXPECT_GT(gantry.status().time, before);
    EXPECT_GT(gantry.status().commanded.z(), kTop + 5);
    expect_recorded(gantry, place(900, 100, 500));
}

TEST(RobotGantry, IsNoFasterThanItsJoints)
{
    robot::Robot robot = irb1400();
    const Work of = work();
    const auto run = [&] {
        carrier::RobotGantry gantry = gantry_of(robot, of);
        gantry.set_frame(place(900, 100, 500));
        gantry.travel({-5, -15, 12});
        gantry.grind({-5, 15, 9.5}, 40);
        gantry.touch_off();
        const auto moments = gantry.moments();
        for (std::size_t i = 1; i < moments.size(); ++i)
            for (Eigen::Index k = 0; k < 6; ++k) {
                const double turn = std::abs(moments[i].joints[k] - moments[i - 1].joints[k]);
                const double speed = robot.dh[k].max_speed.value_or(1e9);
                EXPECT_LE(turn, speed * (moments[i].time - moments[i - 1].time) * (1 + 1e-6))
                    << i << " joint " << k + 1;
            }
        // Halfway between two moments, the joints moving evenly, the tip is still on its line.
        for (std::size_t i = 1; i < moments.size(); ++i) {
            const robot::Joints halfway = (moments[i].joints + moments[i - 1].joints).head<6>() / 2;
            const Eigen::Vector3d tip = (robot::Arm(robot).flange(halfway) * robot.T_flange_tool).translation();
            const Eigen::Vector3d line = (moments[i].pose.translation() + moments[i - 1].pose.translation()) / 2;
            EXPECT_LT((tip - line).norm(), 0.005) << i;
        }
        EXPECT_NEAR(moments.back().time, gantry.status().time, 10.1); // the touch-off
        return gantry.status().time;
    };
    const double fast = run();
    gantry::QuasiStaticGantry gantry(of.stock, of.plan.job);
    gantry.travel({-5, -15, 12});
    gantry.grind({-5, 15, 9.5}, 40);
    gantry.touch_off();
    EXPECT_EQ(fast, gantry.status().time);
    for (robot::DhRow& row : robot.dh) row.max_speed = 0.01;
    EXPECT_GT(run(), 1.3 * fast);
}

} // namespace carrier_test
} // namespace fettle
