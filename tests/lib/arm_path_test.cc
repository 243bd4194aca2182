#include "core/error.h"
#include "irb1400.h"
#include "robot/arm.h"
#include "robot/arm_report.h"
#include "robot/follow.h"
#include "robot/path_cloud.h"
#include "robot/rates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace fettle {
namespace arm_path_test {

const robot::Track kTrack = {Eigen::Vector3d::UnitY(), {0, 2000}, {}};
const robot::Table kTable = {{1000, 0, 400}, Eigen::Vector3d::UnitZ(), {-360 * kDegree, 360 * kDegree}, {}, ""};

Eigen::Isometry3d upright(double x, double y, double z)
{
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << x, y, z;
    return pose;
}

// A circle in a plane across the robot, the tool upright.
cloud::PosePath circle(int count, double radius = 150)
{
    cloud::PosePath poses;
    for (int i = 0; i < count; ++i) {
        const double phi = 2 * std::numbers::pi * i / (count - 1);
        poses.push_back(upright(1000 + radius * std::cos(phi), radius * std::sin(phi), 500));
    }
    return poses;
}

Eigen::Matrix2Xd at_rest(const cloud::PosePath& poses)
{
    return Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(poses.size()));
}

double largest_step(const robot::FollowedPath& path)
{
    const Eigen::Index n = path.joints.cols() - 1;
    return (path.joints.rightCols(n) - path.joints.leftCols(n)).topRows<6>().cwiseAbs().maxCoeff();
}

TEST(Follow, JointsBringTheToolBack)
{
    robot::Robot robot = irb1400();
    robot.track = kTrack;
    robot.table = kTable;
    robot.T_cell_base = Eigen::Translation3d(10, -800, 30) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ());
    const cloud::PosePath poses = circle(101);
    const Eigen::Matrix2Xd externals = robot::external_values(robot, poses, {true, -50}, {false, 0.3});
    const robot::FollowedPath path = robot::follow_path(robot, poses, externals);
    EXPECT_TRUE(path.jumps.empty());
    const cloud::PosePath back = robot::forward_kinematics(robot, path.joints);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        EXPECT_EQ(path.state[i], robot::PoseState::reached);
        EXPECT_LT((back[i].matrix() - poses[i].matrix()).cwiseAbs().maxCoeff(), 1e-9);
    }
    EXPECT_LT(largest_step(path), 0.2);
}

// Reference: all paths through all solutions, one by one.
TEST(Follow, NoPathIsShorter)
{
    const robot::Robot robot = irb1400();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(-1, 1);
    const robot::Arm arm(robot);
    for (int k = 0; k < 20; ++k) {
        cloud::PosePath poses;
        std::vector<std::vector<std::pair<int, robot::Joints>>> solutions;
        robot::Joints q = degrees(20 * at(random), 20 * at(random), 20 * at(random), 100 * at(random), 60 * at(random),
                                  200 * at(random));
        for (int i = 0; i < 4; ++i) {
            q += 0.4 * robot::Joints::NullaryExpr([&] { return at(random); });
            if (!arm.in_range(q)) break;
            poses.push_back(arm.flange(q) * robot.T_flange_tool);
            solutions.push_back(robot::all_solutions(robot, arm.flange(q)));
        }
        const robot::FollowOptions options;
        const robot::FollowedPath path = robot::follow_path(robot, poses, at_rest(poses), options);
        std::pair<int, double> best = {1000, 0}, found = {0, 0};
        const auto add = [&](std::pair<int, double>& sum, const robot::Joints& from, const robot::Joints& to,
                             bool first) {
            if (!first && (to - from).cwiseAbs().maxCoeff() > options.jump_threshold) ++sum.first;
            sum.second += (to - from).squaredNorm();
        };
        const std::function<void(std::size_t, const robot::Joints&, std::pair<int, double>)> go =
            [&](std::size_t i, const robot::Joints& from, std::pair<int, double> sum) {
                if (i == poses.size()) {
                    best = std::min(best, sum);
                    return;
                }
                for (const auto& [branch, joints] : solutions[i]) {
                    std::pair<int, double> on = sum;
                    add(on, from, joints, i == 0);
                    go(i + 1, joints, on);
                }
            };
        go(0, options.start, {0, 0});
        robot::Joints from = options.start;
        for (Eigen::Index i = 0; i < path.joints.cols(); ++i) {
            add(found, from, path.joints.col(i).head<6>(), i == 0);
            from = path.joints.col(i).head<6>();
        }
        EXPECT_EQ(found.first, best.first);
        EXPECT_EQ(found.first, static_cast<int>(path.jumps.size()));
        EXPECT_NEAR(found.second, best.second, 1e-9);
    }
}

// A tool that turns on the spot by 560 degrees fits joint 6 (600 degrees) only from near one of its ends, which is a
// whole turn from the nearest solution; one of 640 does not fit, and is broken once.
TEST(Follow, LooksAheadOverWholeTurns)
{
    const robot::Robot robot = irb1400();
    const robot::Arm arm(robot);
    const auto spin = [&](double turn) {
        cloud::PosePath poses;
        const Eigen::Isometry3d first = arm.flange(degrees(0, 0, 0, 0, 30, 80));
        for (int i = 0; i <= 64; ++i)
            poses.push_back(first * Eigen::AngleAxisd(turn * kDegree * i / 64, Eigen::Vector3d::UnitZ()) *
                            robot.T_flange_tool);
        return robot::follow_path(robot, poses, at_rest(poses));
    };
    EXPECT_TRUE(spin(560).jumps.empty());
    EXPECT_EQ(spin(640).jumps.size(), 1u);
}

// A table within 10 to 350 degrees that follows a tip all around must once turn back by 340 degrees; the track is none
// of what turns.
TEST(Follow, ATableThatTurnsBackJumps)
{
    robot::Robot robot = irb1400();
    robot.table = robot::Table{{1000, 0, 0}, Eigen::Vector3d::UnitZ(), {10 * kDegree, 350 * kDegree}, {}, ""};
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 4);
    joints.row(7) << 340 * kDegree, 349 * kDegree, 11 * kDegree, 20 * kDegree;
    EXPECT_EQ(robot::evaluate_joints(robot, joints, 30 * kDegree).jumps, std::vector<Eigen::Index>{2});
    joints.row(7).setConstant(kDegree);
    joints.row(6) << 0, 500, 1000, 1500;
    EXPECT_TRUE(robot::evaluate_joints(robot, joints, 30 * kDegree).jumps.empty());
}

TEST(Follow, StatesNameTheFault)
{
    const robot::Robot robot = irb1400();
    cloud::PosePath poses = circle(9);
    poses[2].translation().x() = 5000;
    poses[4].translation().setConstant(NAN);
    poses[6] = robot::Arm(robot).flange(degrees(0, 0, 75, 0, 60, 0)) * robot.T_flange_tool; // joint 3 ends at 70
    const robot::FollowedPath path = robot::follow_path(robot, poses, at_rest(poses));
    EXPECT_EQ(path.state[1], robot::PoseState::reached);
    EXPECT_EQ(path.state[2], robot::PoseState::unreachable);
    EXPECT_EQ(path.state[4], robot::PoseState::undefined);
    EXPECT_EQ(path.state[6], robot::PoseState::out_of_range);
    EXPECT_EQ(path.out_of_range_counts.sum(), 1);
    EXPECT_EQ(path.out_of_range_counts[2], 1);
    EXPECT_TRUE(path.joints.col(2).hasNaN());
    EXPECT_TRUE(path.jumps.empty());
}

TEST(Externals, CollisionsMoveTheTrack)
{
    robot::Robot robot = irb1400();
    robot.track = kTrack;
    cloud::PosePath poses = circle(50);
    for (Eigen::Isometry3d& pose : poses) pose.translation().y() += 900;
    const robot::ExternalChoice unaware = robot::choose_externals(robot, poses, {});
    const double farther = unaware.track.value + 130;
    const auto beyond = [&](const robot::CellJoints& joints) { return joints[6] >= farther; };
    const robot::ExternalChoice clear = robot::choose_externals(robot, poses, {}, beyond);
    EXPECT_EQ(clear.unreached, 0);
    EXPECT_EQ(clear.colliding, 0);
    EXPECT_GE(clear.track.value, farther);
    EXPECT_LE(clear.singularity, unaware.singularity);
    // Where each collides, the choice is that of reach.
    const robot::ExternalChoice none = robot::choose_externals(robot, poses, {}, [](const auto&) { return false; });
    EXPECT_EQ(none.track.value, unaware.track.value);
    EXPECT_GT(none.colliding, 0);
    // The choice of a few poses that cannot be clear is the one with the fewest.
    const auto half = [&](const robot::CellJoints& joints) { return joints[6] >= farther && joints[0] > 0; };
    const robot::ExternalChoice fewest = robot::choose_externals(robot, poses, {}, half);
    EXPECT_LT(fewest.colliding, none.colliding);
}

TEST(Externals, AxesRestIfAllowed)
{
    robot::Robot robot = irb1400();
    robot.track = kTrack;
    cloud::PosePath poses = circle(50);
    for (Eigen::Isometry3d& pose : poses) pose.translation().y() += 900;
    const robot::ExternalChoice at_rest_choice = robot::choose_externals(robot, poses, {});
    EXPECT_EQ(at_rest_choice.unreached, 0);
    EXPECT_FALSE(at_rest_choice.track.follows);
    for (const double place : {400.0, 700.0, 1000.0, 1300.0}) {
        const robot::ExternalChoice there = robot::choose_externals(robot, poses, {robot::AxisRule{false, place}, {}});
        EXPECT_TRUE(there.unreached > 0 || there.singularity <= at_rest_choice.singularity);
    }
    // a line as long as the track needs it to follow
    cloud::PosePath line;
    for (int i = 0; i <= 100; ++i) line.push_back(upright(1000, -300 + 26 * i, 500));
    const robot::ExternalChoice follows = robot::choose_externals(robot, line, {});
    EXPECT_EQ(follows.unreached, 0);
    EXPECT_TRUE(follows.track.follows);
    const Eigen::Matrix2Xd values = robot::external_values(robot, line, follows.track, {});
    EXPECT_GE(values.row(0).minCoeff(), 0);
    EXPECT_LE(values.row(0).maxCoeff(), 2000);
    const robot::FollowedPath path = robot::follow_path(robot, line, values);
    EXPECT_TRUE(path.jumps.empty());
    EXPECT_TRUE(std::all_of(path.state.begin(), path.state.end(),
                            [](robot::PoseState s) { return s == robot::PoseState::reached; }));
    EXPECT_THROW(robot::parse_axis_rule("follow", 1), core::InputError);
    EXPECT_THROW(robot::parse_axis_rule("nan", 1), core::InputError);
    EXPECT_FALSE(robot::parse_axis_rule("auto", 1));
    EXPECT_EQ(robot::parse_axis_rule("follow:-5", 2)->value, -10);
}

// The far side of a part is reached when the table turns it to the robot: its tip then has the requested azimuth.
TEST(Externals, TableTurnsThePartToTheRobot)
{
    robot::Robot robot = irb1400();
    robot.table = kTable;
    const cloud::PosePath poses = circle(73, 700);
    const double to_the_robot = std::numbers::pi;
    const Eigen::Matrix2Xd values = robot::external_values(robot, poses, {}, {true, to_the_robot});
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Eigen::Vector3d tip =
            robot::part_in_cell(robot, values(1, static_cast<Eigen::Index>(i))) * poses[i].translation();
        EXPECT_LT((tip - Eigen::Vector3d(300, 0, 500)).norm(), 1e-9);
    }
    EXPECT_LT((values.row(1).tail(72) - values.row(1).head(72)).cwiseAbs().maxCoeff(), 0.1); // no turn is skipped
}

// Only joint 1 turns, by 1 degree a pose: the tip moves along a chord of its circle.
TEST(Rates, OfAJointThatTurnsEvenly)
{
    robot::Robot robot = irb1400();
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 21);
    for (Eigen::Index i = 0; i < 21; ++i) joints.col(i).head<6>() = degrees(static_cast<double>(i), 0, 0, 0, 30, 0);
    const cloud::PosePath poses = robot::forward_kinematics(robot, joints);
    const robot::FollowedPath path = robot::evaluate_joints(robot, joints, 0.5);
    const double radius = poses[0].translation().head<2>().norm(), chord = 2 * radius * std::sin(kDegree / 2);
    const Eigen::VectorXd times = robot::arrival_times(poses, {100});
    EXPECT_NEAR(times[20], 20 * chord / 100, 1e-9);
    std::array<robot::JointRate, 8> rates = robot::joint_rates(robot, path, times);
    EXPECT_NEAR(rates[0].speed, kDegree * 100 / chord, 1e-9);
    EXPECT_NEAR(rates[0].acceleration, 0, 1e-9);
    EXPECT_EQ(rates[1].speed, 0);
    robot.dh[0].max_speed = 0.99 * rates[0].speed;
    EXPECT_EQ(robot::joint_rates(robot, path, times)[0].over_limit_count, 20);
    robot.dh[0].max_speed = 1.01 * rates[0].speed;
    EXPECT_EQ(robot::joint_rates(robot, path, times)[0].over_limit_count, 0);
    // the turn's own limit, 1 degree a second, makes it slower
    EXPECT_NEAR(robot::joint_rates(robot, path, robot::arrival_times(poses, {100, kDegree}))[0].speed, kDegree, 1e-9);
}

// q = t³ along unevenly spaced times: the difference quotients differ from 3 t² and 6 t by their second order.
TEST(Rates, ConvergeToTheDerivatives)
{
    const robot::Robot robot = irb1400();
    const auto errors = [&](Eigen::Index n) {
        robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, n + 1);
        Eigen::VectorXd times(n + 1);
        for (Eigen::Index i = 0; i <= n; ++i) {
            times[i] = static_cast<double>(i) / static_cast<double>(n);
            joints(0, i) = std::pow(times[i], 3);
        }
        const robot::JointRate rate = robot::joint_rates(robot, robot::evaluate_joints(robot, joints, 10), times)[0];
        EXPECT_EQ(rate.speed_at, n);
        EXPECT_EQ(rate.acceleration_at, n - 1);
        const double h = 1.0 / static_cast<double>(n);
        return Eigen::Vector2d(rate.speed - 3 * std::pow(1 - h / 2, 2), rate.acceleration - 6 * (1 - h))
            .cwiseAbs()
            .maxCoeff();
    };
    EXPECT_LT(errors(50), 2e-4);
    EXPECT_NEAR(errors(100) / errors(50), 0.25, 0.05);
}

TEST(PathCloud, GoesThereAndBack)
{
    robot::Robot robot = irb1400();
    robot.track = kTrack;
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Matrix3Xd::Zero(3, 3);
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 3);
    joints.col(0).head<7>() << degrees(10, 20, 30, 40, 50, 60), 700;
    joints.col(2).setConstant(NAN);
    robot::set_joints(cloud, robot, joints);
    EXPECT_NEAR(cloud::field(cloud, "joint4")[0], 40, 1e-12);
    EXPECT_NEAR(cloud::field(cloud, "joint7")[0], 700, 1e-12);
    EXPECT_FALSE(cloud::has_field(cloud, "joint8"));
    const cloud::PosePath poses = robot::forward_kinematics(robot, robot::path_joints(cloud, robot));
    cloud::set_poses(cloud, poses);
    const cloud::PosePath again = cloud::read_poses(cloud);
    EXPECT_LT((again[0].matrix() - poses[0].matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_TRUE(again[2].translation().hasNaN());
    cloud::set_field(cloud, "qw", Eigen::VectorXd::Zero(3), 8);
    cloud::set_field(cloud, "qx", Eigen::VectorXd::Zero(3), 8);
    cloud::set_field(cloud, "qy", Eigen::VectorXd::Zero(3), 8);
    cloud::set_field(cloud, "qz", Eigen::VectorXd::Zero(3), 8);
    EXPECT_THROW(cloud::read_poses(cloud), core::InputError);
}

} // namespace arm_path_test
} // namespace fettle
