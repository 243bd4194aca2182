#include "boat_hull.h"
#include "irb1400.h"
#include "robot/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fettle {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// Upper arm, forearm, hand and a tool with a ball; a ball-shaped fixture where a test wants it.
Robot cell(const Vector3d& fixture, double radius)
{
    Robot robot = irb1400();
    robot.bodies = {{"upper", 2, solid::Capsule{{600, 0, 0}, {0, 0, 0}, 90}},
                    {"forearm", 3, solid::Cylinder{{0, 0, 0}, {0, 0, 600}, 80}},
                    {"hand", 5, solid::Capsule{{0, 0, 0}, {0, 0, 40}, 45}},
                    {"ball", link::kTool, solid::Sphere{{0, 0, 6}, 6}},
                    {"shank", link::kTool, solid::Cylinder{{0, 0, 6}, {0, 0, 60}, 5}},
                    {"fixture", link::kCell, solid::Sphere{fixture, radius}}};
    return robot;
}

CellJointsPath path_of(const std::vector<Joints>& joints)
{
    CellJointsPath path = CellJointsPath::Zero(8, static_cast<Eigen::Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) path.col(static_cast<Eigen::Index>(i)).head<6>() = joints[i];
    return path;
}

TEST(Collision, PairsThatAreChecked)
{
    Robot robot = cell({0, 0, 0}, 1);
    const auto has = [&](std::size_t a, std::size_t b) {
        const std::vector<CellPair> pairs = checked_pairs(robot);
        return std::any_of(pairs.begin(), pairs.end(), [&](const CellPair& p) { return p.a == a && p.b == b; });
    };
    EXPECT_FALSE(has(0, 1)); // neighbouring links
    EXPECT_TRUE(has(0, 2));
    EXPECT_FALSE(has(3, 4)); // one link
    EXPECT_TRUE(has(0, 5));
    EXPECT_TRUE(has(3, 6));  // the workpiece
    EXPECT_FALSE(has(5, 6)); // stands where it stands
    robot.allowed = {{0, 5}};
    EXPECT_FALSE(has(0, 5));
    robot.table = Table{{1000, 0, 0}, Vector3d::UnitZ(), {-10, 10}, {}, ""};
    EXPECT_TRUE(has(5, 6)); // the table turns it against the fixture
}

// Home: the forearm lies along x at z 1195 from x 150 to 750, with radius 80.
TEST(Collision, ClearanceByHand)
{
    const CellJointsPath home = path_of({Joints::Zero()});
    Robot robot = cell({500, 200, 1195}, 50);
    CheckedPath checked = check_path(robot, nullptr, home, {});
    const std::vector<CellPair> pairs = checked_pairs(robot);
    EXPECT_EQ(checked.pose[0].clearance, 50); // 70, but clearances are told up to 50
    checked = check_path(robot, nullptr, home, {0.01, 100, 0.1});
    EXPECT_NEAR(checked.pose[0].clearance, 200 - 80 - 50, 1e-6);
    EXPECT_EQ(pairs[checked.pose[0].pair].a, 1u);
    EXPECT_EQ(pairs[checked.pose[0].pair].b, 5u);
    EXPECT_LT((checked.pose[0].point - Vector3d(500, 80, 1195)).norm(), 1e-5);
    robot.margins = {{{1, 5}, 30}};
    EXPECT_NEAR(check_path(robot, nullptr, home, {0.01, 100, 0.1}).pose[0].clearance, 40, 1e-6);
    robot = cell({500, 120, 1195}, 50);
    EXPECT_NEAR(check_path(robot, nullptr, home, {}).pose[0].clearance, -10, 1e-4);
    EXPECT_TRUE(std::isnan(check_path(robot, nullptr, path_of({Joints::Constant(NAN)}), {}).pose[0].clearance));
}

// A rod of 1 mm between two poses that are both clear of it is found; one beside the way is no collision.
TEST(Collision, NoThinObstacleIsMissed)
{
    const Joints from = degrees(0, 20, 20, 0, 60, 0), to = degrees(6, 20, 20, 0, 60, 0);
    Robot robot = cell({0, 0, 0}, 1);
    const auto tip = [&](const Joints& q) { return (Arm(robot).flange(q) * robot.T_flange_tool).translation().eval(); };
    const Vector3d middle = tip((from + to) / 2);
    ASSERT_GT((tip(from) - tip(to)).norm(), 100);
    const auto check = [&](const Vector3d& foot) {
        robot.bodies.back().solid = solid::Capsule{foot - Vector3d(0, 0, 20), foot + Vector3d(0, 0, 3), 0.5};
        return check_path(robot, nullptr, path_of({from, to}), {});
    };
    const CheckedPath through = check(middle);
    EXPECT_GT(through.pose[0].clearance, 10);
    EXPECT_GT(through.pose[1].clearance, 10);
    EXPECT_LT(through.between[1].clearance, -1);
    EXPECT_TRUE(std::isnan(through.between[0].clearance));
    const CheckedPath beside = check(middle - Vector3d(0, 0, 10)); // 7 mm under the tip
    EXPECT_GE(beside.between[1].clearance, -0.01);
    EXPECT_GT(beside.looks, 1u);
}

// Reference: a thousand looks on the way. The bound is below all of them.
TEST(Collision, BoundBetweenPosesHolds)
{
    std::mt19937 random(12);
    const auto number = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    int near = 0;
    for (int k = 0; k < 150; ++k) {
        Robot robot = cell({number(300, 1200), number(-400, 400), number(300, 1300)}, 60);
        robot.coupling = k % 2 == 0 ? Coupling::parallelogram : Coupling::serial;
        const Joints from = degrees(number(-20, 20), number(-20, 40), number(-20, 40), number(-90, 90), number(-80, 80),
                                    number(-90, 90));
        const Joints to =
            from + degrees(number(-9, 9), number(-9, 9), number(-9, 9), number(-9, 9), number(-9, 9), number(-9, 9));
        const CollisionOptions options = {0.01, 1000, 0.1};
        const CheckedPath checked = check_path(robot, nullptr, path_of({from, to}), options);
        std::vector<Joints> dense;
        for (int i = 0; i <= 300; ++i) dense.push_back(from + (to - from) * i / 300);
        const CheckedPath at_all = check_path(robot, nullptr, path_of(dense), options);
        double least = INFINITY;
        for (const CellClearance& c : at_all.pose) least = std::min(least, c.clearance);
        if (checked.between[1].clearance >= -options.tolerance) { // else it is the depth of a look
            EXPECT_LE(checked.between[1].clearance, least + options.resolution / 2 + 1e-4);
        }
        if (least < -options.tolerance - options.resolution / 2) {
            ++near;
            EXPECT_LT(checked.between[1].clearance, -options.tolerance);
        }
        if (checked.between[1].clearance < -options.tolerance) {
            EXPECT_LT(least, 0.01);
        }
    }
    EXPECT_GT(near, 3);
}

// Along a path most pairs are not looked at. Reference: all of them at every pose, from scratch. The arm wanders among
// a fixture and a hull, by small steps and now and then a large one, and sinks into both.
TEST(Collision, AWalkTellsWhatLookingAtAllPairsTells)
{
    Mesh mesh = boat::hull(3000);
    mesh.vertices.colwise() += Vector3d(1150, -100, 850);
    const Workpiece workpiece(mesh);
    std::mt19937 random(15);
    std::normal_distribution<double> normal;
    int deep = 0, near = 0;
    for (int k = 0; k < 12; ++k) {
        const Robot robot = cell({1000, 250, 1000}, 100);
        std::vector<Joints> joints = {degrees(5, 20, 20, 0, 60, 0)};
        while (joints.size() < 150) {
            const double step = joints.size() % 40 == 0 ? 0.2 : 0.01;
            const Joints next = joints.back() + step * Joints::NullaryExpr([&] { return normal(random); });
            joints.push_back(0.98 * next + 0.02 * joints.front());
        }
        const CollisionOptions options = {0.01, k % 3 == 0 ? 500.0 : 50.0, 0.1};
        const CellJointsPath path = path_of(joints);
        const CheckedPath checked = check_path(robot, &workpiece, path, options);
        const Cell all(robot, &workpiece, options);
        for (Eigen::Index i = 0; i < path.cols(); ++i) {
            Stance stance = all.stand(path.col(i));
            double least = INFINITY;
            for (const std::size_t pair : all.looked_at()) {
                all.look(stance, pair);
                least = std::min(least, stance.pairs[pair].clearance);
            }
            const CellClearance& told = checked.pose[static_cast<std::size_t>(i)];
            EXPECT_NEAR(told.clearance, least, kClearanceTolerance);
            EXPECT_NEAR(stance.pairs[told.pair].clearance, least, kClearanceTolerance);
            if (i > 0) {
                EXPECT_LE(checked.between[static_cast<std::size_t>(i)].clearance, least + kClearanceTolerance);
            }
            deep += least < -1;
            near += least > 0 && least < 20;
        }
    }
    EXPECT_GT(deep, 50);
    EXPECT_GT(near, 50);
}

// The workpiece turns with the table: what touches at 0 degrees does not at 180.
TEST(Collision, WorkpieceLiesOnTheTable)
{
    Robot robot = cell({0, 0, -5000}, 1);
    robot.table = Table{{1155, 0, 0}, Vector3d::UnitZ(), {-10, 10}, {}, ""};
    Mesh mesh;
    mesh.vertices.resize(3, 3);
    mesh.vertices << 1200, 1300, 1250, -50, -50, 50, 1095, 1095, 1095;
    mesh.triangles = Eigen::Vector3i(0, 1, 2);
    const Workpiece workpiece(mesh);
    CellJointsPath home = path_of({Joints::Zero(), Joints::Zero()});
    home(7, 1) = std::numbers::pi;
    const CheckedPath checked = check_path(robot, &workpiece, home, {0.01, 200, 0.1});
    // the ball's centre stands at 1149, 0; the near side of the triangle goes from 1200, -50 to 1250, 50
    const double side = std::hypot(50, 100);
    EXPECT_NEAR(checked.pose[0].clearance, (51 * 100 + 50 * 50) / side - 6, 1e-5);
    // turned half about 1155, 0 that side goes from 1110, 50 to 1060, -50; the shank ends at 1095 with radius 5
    EXPECT_NEAR(checked.pose[1].clearance, (-15 * 100 + 45 * 50) / side, 1e-5);
}

} // namespace
} // namespace fettle
