// What collides is led around. References: sines of tilts, exhaustive search, and trying what is passed over.
#include "cloud/fields.h"
#include "irb1400.h"
#include "robot/avoid.h"
#include "robot/avoid_report.h"
#include "robot/layered_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>

namespace fettle {

namespace avoid_test {

using Eigen::Isometry3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kBall = 6;
// Ends of the tool's arm, a rod beside a wall, above the tip.
constexpr double kRodLow = 100, kRodHigh = 180, kRod = 20;

robot::Robot with_tool(std::vector<robot::Body> more)
{
    robot::Robot robot = irb1400();
    robot.bodies = {{"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, kBall}, kBall}},
                    {"rod", robot::link::kTool, robot::solid::Capsule{{0, 0, kRodLow}, {0, 0, kRodHigh}, kRod}}};
    robot.bodies.insert(robot.bodies.end(), more.begin(), more.end());
    return robot;
}

// Beyond y = `from`, along x about 1000, at the height of the rod.
robot::Body wall(double from, double half_length = 500)
{
    const Vector3d min(1000 - half_length, from, 560), max(1000 + half_length, 1500, 900);
    return {"wall", robot::link::kCell,
            robot::solid::Box{Isometry3d(Eigen::Translation3d((min + max) / 2)), (max - min) / 2}};
}

// Upright along x, a millimetre apart, tips at z = 500.
cloud::PosePath along_x(double from, int count)
{
    cloud::PosePath poses;
    for (int i = 0; i < count; ++i) poses.emplace_back(Eigen::Translation3d(from + i, 0, 500));
    return poses;
}

robot::SolvedPath solve(const robot::Robot& robot, const cloud::PosePath& poses)
{
    robot::SolvedPath solved;
    solved.poses = poses;
    solved.external_values = Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(poses.size()));
    solved.path = robot::follow_path(robot, poses, solved.external_values);
    return solved;
}

Eigen::Matrix3Xd upwards(const robot::SolvedPath& solved)
{
    return Vector3d::UnitZ().replicate(1, static_cast<Eigen::Index>(solved.poses.size()));
}

struct Case {
    Case(robot::Robot r, const cloud::PosePath& poses, const robot::Workpiece* w = nullptr)
        : robot(std::move(r)), workpiece(w), solved(solve(robot, poses)),
          before(robot::check_path(robot, workpiece, solved.path.joints, collision)), away(upwards(solved))
    {
    }
    robot::AvoidedPath run(const robot::AvoidOptions& options) const
    {
        return robot::avoid_collisions(robot, workpiece, solved, before, away, options, collision);
    }
    static robot::AvoidOptions smooth() { return {.smooth = true}; }

    robot::Robot robot;
    const robot::Workpiece* workpiece;
    robot::CollisionOptions collision;
    robot::SolvedPath solved;
    robot::CheckedPath before;
    Eigen::Matrix3Xd away;
};

double largest_change(const std::vector<robot::PoseChange>& changes)
{
    double max = 0;
    for (std::size_t i = 1; i < changes.size(); ++i)
        max = std::max(max, robot::tilt_between(changes[i - 1].tilt, changes[i].tilt));
    return max;
}

int colliding(const robot::CheckedPath& checked, const robot::CollisionOptions& options)
{
    int count = 0;
    for (std::size_t i = 0; i < checked.at_poses.size(); ++i)
        count += checked.at_poses[i].clearance < -options.tolerance ||
                 checked.between_poses[i].clearance < -options.tolerance;
    return count;
}

// A square plate at a height, 40 mm wide about (x, 0).
mesh::Mesh plate(double x, double z)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 4);
    mesh.vertices << x - 20, x + 20, x + 20, x - 20, -20, -20, 20, 20, z, z, z, z;
    mesh.triangles.resize(3, 2);
    mesh.triangles << 0, 0, 1, 2, 2, 3;
    return mesh;
}

TEST(Tilt, ContactStays)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    const double pivot = robot::tilt_pivot(with_tool({}));
    EXPECT_EQ(pivot, kBall);
    for (int i = 0; i < 1000; ++i) {
        const Isometry3d pose = Eigen::Translation3d(1000 * any(random), any(random), any(random)) *
                                Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
        const robot::PoseChange change{0.5 * Vector2d(any(random), any(random)), 0};
        const Isometry3d tilted = robot::changed_pose(pose, change, pivot, Vector3d::UnitZ());
        // The ball stays, so its contact point does not depend on the normal.
        EXPECT_LT((tilted * Vector3d(0, 0, kBall) - pose * Vector3d(0, 0, kBall)).norm(), 1e-10);
        const double angle = std::acos(std::min(1.0, tilted.linear().col(2).dot(pose.linear().col(2))));
        EXPECT_NEAR(angle, change.tilt.norm(), 1e-7);
        // No twist: the axis of the turn is across the tool.
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear().transpose() * tilted.linear()));
        EXPECT_LT(std::abs(turn.axis().z()) * turn.angle(), 1e-10);
    }
}

TEST(Tilt, PivotIsTheTipWithoutABallEnd)
{
    robot::Robot robot = irb1400();
    EXPECT_EQ(robot::tilt_pivot(robot), 0);
    robot.bodies = {{"flat", robot::link::kTool, robot::solid::Cylinder{{0, 0, 0}, {0, 0, 50}, 5}},
                    {"knob", robot::link::kTool, robot::solid::Sphere{{0, 0, 60}, 8}}};
    EXPECT_EQ(robot::tilt_pivot(robot), 0);
    robot.bodies.push_back({"round", robot::link::kTool, robot::solid::Capsule{{0, 0, 40}, {0, 0, 5}, 5}});
    EXPECT_EQ(robot::tilt_pivot(robot), 5);
}

// The rod is `deep` in a wall. A tilt by an angle away from it moves the rod's low end, nearest to the pivot and so the
// last to come free, by (kRodLow - kBall) times its sine.
TEST(Avoid, FirstConeThatIsClear)
{
    for (const double deep : {3.0, 12.0, 25.0, 40.0}) {
        const Case c(with_tool({wall(kRod - deep)}), along_x(1000, 1));
        EXPECT_NEAR(c.before.at_poses[0].clearance, -deep, 1e-4);
        const robot::AvoidedPath avoided = c.run({});
        const double needed = std::asin((deep - c.collision.tolerance) / (kRodLow - kBall));
        const double cone = std::ceil(needed / (5 * kDegree)) * 5;
        EXPECT_NEAR(avoided.changes[0].tilt.norm() / kDegree, cone, 1e-9) << deep;
        EXPECT_EQ(avoided.changes[0].retreat, 0);
        EXPECT_GE(avoided.checked.at_poses[0].clearance, -c.collision.tolerance);
        EXPECT_LT(avoided.poses[0].linear()(1, 2), 0); // away from the wall
        EXPECT_EQ(avoided.path.state[0], robot::PoseState::reached);
        // The joints lead to the pose.
        const Isometry3d reached =
            robot::Arm(c.robot).flange(avoided.path.joints.col(0).head<6>()) * c.robot.T_flange_tool;
        EXPECT_LT((reached.matrix() - avoided.poses[0].matrix()).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(Avoid, ReportsCollisionsBeyondTheLargestTilt)
{
    const double deep = 80; // asin(80 / 94) is more than 45 degrees
    const Case c(with_tool({wall(kRod - deep)}), along_x(1000, 1));
    for (const robot::AvoidOptions& options : {robot::AvoidOptions(), Case::smooth()}) {
        const robot::AvoidedPath avoided = c.run(options);
        EXPECT_EQ(avoided.changes[0].tilt.norm(), 0);
        EXPECT_TRUE(avoided.poses[0].isApprox(c.solved.poses[0], 0));
        EXPECT_EQ(avoided.checked.at_poses[0].clearance, c.before.at_poses[0].clearance);
    }
    robot::AvoidOptions wider;
    wider.max_tilt = 70 * kDegree;
    EXPECT_NEAR(c.run(wider).changes[0].tilt.norm() / kDegree, 60, 1e-9);
}

// A ball that is 0.25 mm deep in the workpiece: no tilt helps, the third step back does.
TEST(Avoid, Retreats)
{
    const mesh::Mesh mesh = plate(1000, 500.25);
    const robot::Workpiece workpiece(mesh);
    const Case c(with_tool({}), along_x(1000, 1), &workpiece);
    EXPECT_NEAR(c.before.at_poses[0].clearance, -0.25, 1e-9);
    const robot::AvoidedPath avoided = c.run({});
    EXPECT_EQ(avoided.changes[0].tilt.norm(), 0);
    EXPECT_NEAR(avoided.changes[0].retreat, 0.3, 1e-12);
    EXPECT_NEAR(avoided.checked.at_poses[0].clearance, 0.05, 1e-9);
    EXPECT_NEAR(avoided.poses[0].translation().z(), 500.3, 1e-9);
    robot::AvoidOptions near;
    near.max_retreat = 0.2;
    EXPECT_EQ(c.run(near).changes[0], robot::PoseChange());
}

TEST(Avoid, WhatIsClearStaysToTheLastBit)
{
    const Case c(with_tool({wall(500)}), along_x(1000, 20));
    for (const robot::AvoidOptions& options : {robot::AvoidOptions(), Case::smooth()}) {
        const robot::AvoidedPath avoided = c.run(options);
        EXPECT_EQ(avoided.path.joints, c.solved.path.joints);
        for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(avoided.changes[i], robot::PoseChange());
    }
}

// Along a wall that begins and ends beside the path: pose by pose the tool jerks, smoothly it leans early.
TEST(Avoid, SmoothChangesLittle)
{
    const Case c(with_tool({wall(kRod - 15, 50)}), along_x(800, 400));
    const robot::AvoidedPath by_pose = c.run({}), smooth = c.run(Case::smooth());
    EXPECT_GE(largest_change(by_pose.changes), 4.99 * kDegree); // from cone to cone at least
    EXPECT_LE(largest_change(smooth.changes), 0.3 * largest_change(by_pose.changes));
    EXPECT_EQ(colliding(smooth.checked, c.collision), 0);
    EXPECT_TRUE(smooth.path.jumps.empty());
    EXPECT_EQ(smooth.changes.front(), robot::PoseChange());
    EXPECT_EQ(smooth.changes.back(), robot::PoseChange());
    // No more tilt than is needed, but for the last steps between tilts.
    double max = 0;
    for (const robot::PoseChange& change : smooth.changes) max = std::max(max, change.tilt.norm());
    EXPECT_NEAR(max, std::asin(15 / (kRodLow - kBall)), 0.5 * kDegree);
    // The reported clearances of the changed path agree with a new check of it.
    const robot::CheckedPath again = robot::check_path(c.robot, nullptr, smooth.path.joints, c.collision);
    for (std::size_t i = 0; i < again.at_poses.size(); ++i)
        EXPECT_EQ(again.at_poses[i].clearance, smooth.checked.at_poses[i].clearance);
}

TEST(Avoid, PosesThatTheArmCannotReachUpright)
{
    // At the end of its reach the tool must lean outwards or the wrist is too far away.
    robot::Robot robot = with_tool({});
    robot::SolvedPath solved = solve(robot, along_x(1500, 300));
    std::size_t unreached = 0;
    for (const robot::PoseState state : solved.path.state) unreached += state == robot::PoseState::reached ? 0 : 1;
    ASSERT_GT(unreached, 0u);
    const Case c(robot, along_x(1500, 300));
    const robot::AvoidedPath avoided = c.run({});
    std::size_t left = 0;
    for (const robot::PoseState state : avoided.path.state) left += state == robot::PoseState::reached ? 0 : 1;
    EXPECT_LT(left, unreached);
    EXPECT_TRUE(avoided.path.jumps.empty());
    // In reverse order there is no previous pose to begin from; as many are reached.
    cloud::PosePath back = along_x(1500, 300);
    std::reverse(back.begin(), back.end());
    const robot::AvoidedPath inwards = Case(robot, back).run({});
    EXPECT_NEAR(static_cast<double>(
                    std::count(inwards.path.state.begin(), inwards.path.state.end(), robot::PoseState::reached)),
                static_cast<double>(300 - left), 5);
}

// Whatever is passed over as known to collide does collide.
TEST(Blocked, NeverPassesOverWhatIsClear)
{
    const Case c(with_tool({wall(kRod - 15)}), along_x(1000, 1));
    const robot::ChangeChecker trials(c.robot, nullptr, c.collision, c.solved, c.away);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-0.8, 0.8);
    const auto change = [&] { return robot::PoseChange{{any(random), any(random)}, std::abs(any(random))}; };
    robot::CollidingChanges known;
    for (int i = 0; i < 20; ++i) trials.find_clear_joints(0, change(), trials.seed_joints(0), known);
    int passed_over = 0;
    for (int i = 0; i < 2000; ++i) {
        const robot::PoseChange tried = change();
        if (!known.contains(tried)) continue;
        ++passed_over;
        robot::CollidingChanges fresh;
        EXPECT_TRUE(trials.find_clear_joints(0, tried, trials.seed_joints(0), fresh).hasNaN());
    }
    EXPECT_GT(passed_over, 200);
}

TEST(LayeredSearch, AgreesWithEnumerationOfAllPaths)
{
    std::mt19937 random(3);
    std::uniform_int_distribution<int> length(0, 9), fault(0, 5);
    for (int round = 0; round < 200; ++round) {
        constexpr std::size_t kLayers = 4, kStations = 4;
        robot::ViterbiSearch::Cost cost[kLayers][kStations][kStations];
        robot::ViterbiSearch search;
        for (std::size_t k = 0; k < kLayers; ++k) {
            for (auto& from : cost[k])
                for (auto& to : from) to = {fault(random) == 0 ? 1 : 0, double(length(random))};
            search.add(kStations, [&](std::size_t from, std::size_t to) { return cost[k][from][to]; });
        }
        const auto total = [&](const std::vector<std::size_t>& path) {
            robot::ViterbiSearch::Cost sum = cost[0][0][path[0]];
            for (std::size_t k = 1; k < kLayers; ++k) {
                sum.violations += cost[k][path[k - 1]][path[k]].violations;
                sum.length += cost[k][path[k - 1]][path[k]].length;
            }
            return sum;
        };
        robot::ViterbiSearch::Cost min{1000, 0};
        for (std::size_t n = 0; n < 256; ++n) min = std::min(min, total({n & 3, n >> 2 & 3, n >> 4 & 3, n >> 6}));
        EXPECT_EQ(total(search.path()), min);
        EXPECT_EQ(search.path().back(), search.best_end());
    }
}

// Two walls beside one path. The tool leans past the first one, may not jump back, and so passes the second one.
TEST(Avoid, HandsATiltOnToTheNextWall)
{
    const auto beside = [](const char* name, double min_x, double max_x) {
        const Vector3d min(min_x, kRod - 15, 560), max(max_x, 1500, 900);
        return robot::Body{name, robot::link::kCell,
                           robot::solid::Box{Isometry3d(Eigen::Translation3d((min + max) / 2)), (max - min) / 2}};
    };
    const Case c(with_tool({beside("first", 850, 905), beside("second", 980, 1050)}), along_x(900, 100));
    EXPECT_GT(c.before.at_poses[40].clearance, 5); // between them
    robot::AvoidOptions options;
    options.jump_threshold = 2 * kDegree;
    const robot::AvoidedPath avoided = c.run(options);
    EXPECT_EQ(colliding(avoided.checked, c.collision), 0);
    EXPECT_GT(avoided.changes[0].tilt.norm(), 0);
    for (const robot::PoseChange& change : avoided.changes) EXPECT_EQ(change, avoided.changes[0]);
}

// A fin between two poses, higher than any retreat: the ends of the path are where they were.
TEST(Avoid, TakesBackRetreatsThatDoNotHelp)
{
    mesh::Mesh fin;
    fin.vertices.resize(3, 3);
    fin.vertices << 1025, 1025, 1025, -20, 20, 0, 480, 480, 560;
    fin.triangles = Eigen::Vector3i(0, 1, 2);
    const robot::Workpiece workpiece(fin);
    const cloud::PosePath poses = {Isometry3d(Eigen::Translation3d(1000, 0, 500)),
                                   Isometry3d(Eigen::Translation3d(1050, 0, 500))};
    const Case c(with_tool({}), poses, &workpiece);
    ASSERT_GT(c.before.at_poses[0].clearance, 0);
    ASSERT_GT(c.before.at_poses[1].clearance, 0);
    ASSERT_LT(c.before.between_poses[1].clearance, 0);
    const robot::AvoidedPath avoided = c.run({});
    EXPECT_EQ(avoided.path.joints, c.solved.path.joints);
    for (const robot::PoseChange& change : avoided.changes) EXPECT_EQ(change, robot::PoseChange());
    EXPECT_LT(avoided.checked.between_poses[1].clearance, 0);
}

TEST(Avoid, RetreatsAlongNormals)
{
    const Isometry3d on_its_side(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()));
    const cloud::PosePath poses(4, on_its_side);
    cloud::Cloud cloud;
    cloud.xyz.setZero(3, 4);
    const Vector3d axis = -Vector3d::UnitY();
    EXPECT_LT((robot::retreat_directions(cloud, poses).colwise() - axis).norm(), 1e-12);
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, 4);
    normals.col(0) << 0, 3, 4;
    normals.col(2).setConstant(std::numeric_limits<double>::quiet_NaN());
    normals.col(3) << 1, 0, 0;
    cloud::set_normals(cloud, normals);
    Eigen::Matrix3Xd expected = axis.replicate(1, 4);
    expected.col(0) << 0, 0.6, 0.8;
    expected.col(3) << 1, 0, 0;
    EXPECT_LT((robot::retreat_directions(cloud, poses) - expected).norm(), 1e-6);
}

} // namespace avoid_test

} // namespace fettle
