#include "boat_hull.h"
#include "irb1400.h"
#include "robot/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fettle {
namespace collision_test {

using Eigen::Isometry3d, Eigen::Vector3d;

// Upper arm, forearm, hand and a tool with a ball; a ball-shaped fixture where a test wants it.
robot::Robot cell(const Vector3d& fixture, double radius)
{
    robot::Robot robot = irb1400();
    robot.bodies = {{"upper", 2, robot::solid::Capsule{{600, 0, 0}, {0, 0, 0}, 90}},
                    {"forearm", 3, robot::solid::Cylinder{{0, 0, 0}, {0, 0, 600}, 80}},
                    {"hand", 5, robot::solid::Capsule{{0, 0, 0}, {0, 0, 40}, 45}},
                    {"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, 6}, 6}},
                    {"shank", robot::link::kTool, robot::solid::Cylinder{{0, 0, 6}, {0, 0, 60}, 5}},
                    {"fixture", robot::link::kCell, robot::solid::Sphere{fixture, radius}}};
    return robot;
}

robot::CellJointsPath path_of(const std::vector<robot::Joints>& joints)
{
    robot::CellJointsPath path = robot::CellJointsPath::Zero(8, static_cast<Eigen::Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) path.col(static_cast<Eigen::Index>(i)).head<6>() = joints[i];
    return path;
}

TEST(Collision, PairsThatAreChecked)
{
    robot::Robot robot = cell({0, 0, 0}, 1);
    const auto has = [&](std::size_t a, std::size_t b) {
        const std::vector<robot::CellPair> pairs = robot::checked_pairs(robot);
        return std::any_of(pairs.begin(), pairs.end(), [&](const robot::CellPair& p) { return p.a == a && p.b == b; });
    };
    EXPECT_FALSE(has(0, 1)); // neighbouring links
    EXPECT_TRUE(has(0, 2));
    EXPECT_FALSE(has(3, 4)); // one link
    EXPECT_TRUE(has(0, 5));
    EXPECT_TRUE(has(3, 6));  // the workpiece
    EXPECT_FALSE(has(5, 6)); // both are fixed
    robot.allowed = {{0, 5}};
    EXPECT_FALSE(has(0, 5));
    robot.table = robot::Table{{1000, 0, 0}, Vector3d::UnitZ(), {-10, 10}, {}, ""};
    EXPECT_TRUE(has(5, 6)); // the table turns it against the fixture
}

// Home: the forearm lies along x at z 1195 from x 150 to 750, with radius 80.
TEST(Collision, ClearanceByHand)
{
    const robot::CellJointsPath home = path_of({robot::Joints::Zero()});
    robot::Robot robot = cell({500, 200, 1195}, 50);
    robot::CheckedPath checked = robot::check_path(robot, nullptr, home, {});
    const std::vector<robot::CellPair> pairs = robot::checked_pairs(robot);
    EXPECT_EQ(checked.at_poses[0].clearance, 50); // 70, but clearances are reported up to 50
    checked = robot::check_path(robot, nullptr, home, {0.01, 100, 0.1});
    EXPECT_NEAR(checked.at_poses[0].clearance, 200 - 80 - 50, 1e-6);
    EXPECT_EQ(pairs[checked.at_poses[0].pair].a, 1u);
    EXPECT_EQ(pairs[checked.at_poses[0].pair].b, 5u);
    EXPECT_LT((checked.at_poses[0].point - Vector3d(500, 80, 1195)).norm(), 1e-5);
    robot.margins = {{{1, 5}, 30}};
    EXPECT_NEAR(robot::check_path(robot, nullptr, home, {0.01, 100, 0.1}).at_poses[0].clearance, 40, 1e-6);
    robot = cell({500, 120, 1195}, 50);
    EXPECT_NEAR(robot::check_path(robot, nullptr, home, {}).at_poses[0].clearance, -10, 1e-4);
    EXPECT_TRUE(std::isnan(
        robot::check_path(robot, nullptr, path_of({robot::Joints::Constant(NAN)}), {}).at_poses[0].clearance));
}

// A rod of 1 mm between two poses that are both clear of it is found; one beside the motion is no collision.
TEST(Collision, NoThinObstacleIsMissed)
{
    const robot::Joints from = degrees(0, 20, 20, 0, 60, 0), to = degrees(6, 20, 20, 0, 60, 0);
    robot::Robot robot = cell({0, 0, 0}, 1);
    const auto tip = [&](const robot::Joints& q) {
        return (robot::Arm(robot).flange(q) * robot.T_flange_tool).translation().eval();
    };
    const Vector3d middle = tip((from + to) / 2);
    ASSERT_GT((tip(from) - tip(to)).norm(), 100);
    const auto check = [&](const Vector3d& foot) {
        robot.bodies.back().solid = robot::solid::Capsule{foot - Vector3d(0, 0, 20), foot + Vector3d(0, 0, 3), 0.5};
        return robot::check_path(robot, nullptr, path_of({from, to}), {});
    };
    const robot::CheckedPath through = check(middle);
    EXPECT_GT(through.at_poses[0].clearance, 10);
    EXPECT_GT(through.at_poses[1].clearance, 10);
    EXPECT_LT(through.between_poses[1].clearance, -1);
    EXPECT_TRUE(std::isnan(through.between_poses[0].clearance));
    const robot::CheckedPath beside = check(middle - Vector3d(0, 0, 5)); // 1.5 mm under the tip
    EXPECT_GE(beside.between_poses[1].clearance, -0.01);
    EXPECT_GT(beside.midpoint_count, 1u);
}

// Reference: a thousand poses of the motion. The bound is below all of them.
TEST(Collision, BoundBetweenPosesHolds)
{
    std::mt19937 random(12);
    const auto number = [&](double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(random);
    };
    int near = 0;
    for (int k = 0; k < 150; ++k) {
        robot::Robot robot = cell({number(300, 1200), number(-400, 400), number(300, 1300)}, 60);
        robot.coupling = k % 2 == 0 ? robot::Coupling::parallelogram : robot::Coupling::serial;
        const robot::Joints from = degrees(number(-20, 20), number(-20, 40), number(-20, 40), number(-90, 90),
                                           number(-80, 80), number(-90, 90));
        const robot::Joints to =
            from + degrees(number(-9, 9), number(-9, 9), number(-9, 9), number(-9, 9), number(-9, 9), number(-9, 9));
        const robot::CollisionOptions options = {0.01, 1000, 0.1};
        const robot::CheckedPath checked = robot::check_path(robot, nullptr, path_of({from, to}), options);
        std::vector<robot::Joints> dense;
        for (int i = 0; i <= 300; ++i) dense.push_back(from + (to - from) * i / 300);
        const robot::CheckedPath at_all = robot::check_path(robot, nullptr, path_of(dense), options);
        double min = INFINITY;
        for (const robot::CellClearance& c : at_all.at_poses) min = std::min(min, c.clearance);
        if (checked.between_poses[1].clearance >= -options.tolerance) { // else it is the depth at a pose
            EXPECT_LE(checked.between_poses[1].clearance, min + options.resolution / 2 + 1e-4);
        }
        if (min < -options.tolerance - options.resolution / 2) {
            ++near;
            EXPECT_LT(checked.between_poses[1].clearance, -options.tolerance);
        }
        if (checked.between_poses[1].clearance < -options.tolerance) {
            EXPECT_LT(min, 0.01);
        }
    }
    EXPECT_GT(near, 3);
}

// Along a path most pairs are skipped by their motion bounds. Reference: all of them at every pose, from scratch. The
// arm wanders among a fixture and a hull, by small steps and now and then a large one, and sinks into both.
TEST(Collision, IncrementalCheckAgreesWithAllPairs)
{
    mesh::Mesh mesh = boat::hull(3000);
    mesh.vertices.colwise() += Vector3d(1150, -100, 850);
    const robot::Workpiece workpiece(mesh);
    std::mt19937 random(15);
    std::normal_distribution<double> normal;
    int deep = 0, near = 0;
    for (int k = 0; k < 12; ++k) {
        const robot::Robot robot = cell({1000, 250, 1000}, 100);
        std::vector<robot::Joints> joints = {degrees(5, 20, 20, 0, 60, 0)};
        while (joints.size() < 150) {
            const double step = joints.size() % 40 == 0 ? 0.2 : 0.01;
            const robot::Joints next =
                joints.back() + step * robot::Joints::NullaryExpr([&] { return normal(random); });
            joints.push_back(0.98 * next + 0.02 * joints.front());
        }
        const robot::CollisionOptions options = {0.01, k % 3 == 0 ? 500.0 : 50.0, 0.1};
        const robot::CellJointsPath path = path_of(joints);
        const robot::CheckedPath checked = robot::check_path(robot, &workpiece, path, options);
        const robot::Cell all(robot, &workpiece, options);
        for (Eigen::Index i = 0; i < path.cols(); ++i) {
            robot::CellState stance = all.place_bodies(path.col(i));
            double min = INFINITY;
            for (const std::size_t pair : all.active_pairs()) {
                all.measure_clearance(stance, pair);
                min = std::min(min, stance.clearances[pair].clearance);
            }
            const robot::CellClearance& reported = checked.at_poses[static_cast<std::size_t>(i)];
            EXPECT_NEAR(reported.clearance, min, robot::kClearanceAccuracy);
            EXPECT_NEAR(stance.clearances[reported.pair].clearance, min, robot::kClearanceAccuracy);
            if (i > 0) {
                EXPECT_LE(checked.between_poses[static_cast<std::size_t>(i)].clearance,
                          min + robot::kClearanceAccuracy);
            }
            deep += min < -1;
            near += min > 0 && min < 20;
        }
    }
    EXPECT_GT(deep, 50);
    EXPECT_GT(near, 50);
}

// Large motions are divided by bounds of what two bodies move against each other. Reference: two hundred poses of each
// motion, at which no clearance may be below its bound.
TEST(Collision, RelativeMotionBoundHolds)
{
    std::mt19937 random(31);
    const auto number = [&](double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(random);
    };
    double tightest = INFINITY;
    for (int k = 0; k < 60; ++k) {
        robot::Robot robot = cell({number(300, 1200), number(-400, 400), number(300, 1300)}, 60);
        robot.coupling = k % 2 == 0 ? robot::Coupling::parallelogram : robot::Coupling::serial;
        robot.track = robot::Track{Vector3d::UnitY(), {0, 2000}, {}};
        robot.table = robot::Table{{1155, 0, 0}, Vector3d::UnitZ(), {-10, 10}, {}, ""};
        robot.bodies.push_back(
            {"turret", 1, robot::solid::Box{Isometry3d(Eigen::Translation3d(-50, 10, 0)), {200, 150, 100}}});
        robot.bodies.push_back({"clamp", robot::link::kTable, robot::solid::Sphere{{1300, 50, 400}, 30}});
        const robot::CollisionOptions options = {0.01, 5000, 0.1};
        const robot::Cell all(robot, nullptr, options);
        const double size = k % 3 == 0 ? 0.05 : k % 3 == 1 ? 0.5 : 2;
        robot::CellJoints from, to;
        for (Eigen::Index j = 0; j < 8; ++j) from[j] = number(-1, 1), to[j] = from[j] + size * number(-1, 1);
        from[6] = 1000;
        to[6] = 1000 + size * number(-500, 500);
        robot::CellState s0 = all.place_bodies(from), s1 = all.place_bodies(to);
        for (const std::size_t pair : all.active_pairs()) {
            all.measure_clearance(s0, pair);
            all.measure_clearance(s1, pair);
            EXPECT_LE(all.rough_clearance(s0, pair), s0.clearances[pair].clearance + robot::kClearanceAccuracy);
            EXPECT_LE(all.ball_clearance(s0, pair), s0.clearances[pair].clearance + robot::kClearanceAccuracy);
        }
        for (int i = 1; i < 200; ++i) {
            robot::CellState at = all.place_bodies(from + (to - from) * (i / 200.0));
            for (const std::size_t pair : all.active_pairs()) {
                all.measure_clearance(at, pair);
                const double bound = (s0.clearances[pair].clearance + s1.clearances[pair].clearance -
                                      all.relative_motion_bound(pair, from, s0, to, s1)) /
                                     2;
                EXPECT_GE(at.clearances[pair].clearance, bound - robot::kClearanceAccuracy) << k << " pair " << pair;
                tightest = std::min(tightest, at.clearances[pair].clearance - bound);
            }
        }
    }
    EXPECT_LT(tightest, 0.5); // mm: the bound is no larger than it must be
}

// From one pose to another far away, as between two parts of a program. Reference: the motion divided as finely as the
// resolution asks for, wherever something is near.
TEST(Collision, LargeMotionsAreDecidedAsManySmallOnes)
{
    std::mt19937 random(32);
    const auto number = [&](double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(random);
    };
    const robot::CollisionOptions options;
    int colliding = 0, clear = 0;
    for (int k = 0; k < 40; ++k) {
        const robot::Robot robot = cell({number(500, 1200), number(-600, 600), number(600, 1500)}, 150);
        const auto pose = [&] {
            return degrees(number(-60, 60), number(-40, 40), number(-40, 40), number(-100, 100), number(-100, 100),
                           number(-200, 200));
        };
        const robot::Joints from = pose(), to = pose();
        const double between =
            robot::check_path(robot, nullptr, path_of({from, to}), options).between_poses[1].clearance;
        std::vector<robot::Joints> dense;
        constexpr int kSteps = 4000; // of 2 mm at most
        for (int i = 0; i <= kSteps; ++i) dense.push_back(from + (to - from) * i / kSteps);
        double min = INFINITY;
        for (const robot::CellClearance& c : robot::check_path(robot, nullptr, path_of(dense), options).between_poses)
            if (!std::isnan(c.clearance)) min = std::min(min, c.clearance);
        EXPECT_EQ(between < -options.tolerance, min < -options.tolerance) << k << ": " << between << ", " << min;
        ++(between < -options.tolerance ? colliding : clear);
    }
    EXPECT_GT(colliding, 5);
    EXPECT_GT(clear, 5);
}

// The workpiece turns with the table: what touches at 0 degrees does not at 180.
TEST(Collision, WorkpieceLiesOnTheTable)
{
    robot::Robot robot = cell({0, 0, -5000}, 1);
    robot.table = robot::Table{{1155, 0, 0}, Vector3d::UnitZ(), {-10, 10}, {}, ""};
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 3);
    mesh.vertices << 1200, 1300, 1250, -50, -50, 50, 1095, 1095, 1095;
    mesh.triangles = Eigen::Vector3i(0, 1, 2);
    const robot::Workpiece workpiece(mesh);
    robot::CellJointsPath home = path_of({robot::Joints::Zero(), robot::Joints::Zero()});
    home(7, 1) = std::numbers::pi;
    const robot::CheckedPath checked = robot::check_path(robot, &workpiece, home, {0.01, 200, 0.1});
    // the ball's centre is at 1149, 0; the near side of the triangle goes from 1200, -50 to 1250, 50
    const double side = std::hypot(50, 100);
    EXPECT_NEAR(checked.at_poses[0].clearance, (51 * 100 + 50 * 50) / side - 6, 1e-5);
    // turned half about 1155, 0 that side goes from 1110, 50 to 1060, -50; the shank ends at 1095 with radius 5
    EXPECT_NEAR(checked.at_poses[1].clearance, (-15 * 100 + 45 * 50) / side, 1e-5);
}

} // namespace collision_test
} // namespace fettle
