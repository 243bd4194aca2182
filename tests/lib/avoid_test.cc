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

namespace {

using Eigen::Isometry3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kBall = 6;
// Of the tool's arm, a rod beside which a wall stands: from and to, above the tip.
constexpr double kRodLow = 100, kRodHigh = 180, kRod = 20;

Robot with_tool(std::vector<Body> more)
{
    Robot robot = irb1400();
    robot.bodies = {{"ball", link::kTool, solid::Sphere{{0, 0, kBall}, kBall}},
                    {"rod", link::kTool, solid::Capsule{{0, 0, kRodLow}, {0, 0, kRodHigh}, kRod}}};
    robot.bodies.insert(robot.bodies.end(), more.begin(), more.end());
    return robot;
}

// Beyond y = `from`, along x about 1000, at the height of the rod.
Body wall(double from, double half_length = 500)
{
    const Vector3d least(1000 - half_length, from, 560), most(1000 + half_length, 1500, 900);
    return {"wall", link::kCell, solid::Box{Isometry3d(Eigen::Translation3d((least + most) / 2)), (most - least) / 2}};
}

// Upright along x, a millimetre apart, tips at z = 500.
PosePath along_x(double from, int count)
{
    PosePath poses;
    for (int i = 0; i < count; ++i) poses.emplace_back(Eigen::Translation3d(from + i, 0, 500));
    return poses;
}

SolvedPath solve(const Robot& robot, const PosePath& poses)
{
    SolvedPath solved;
    solved.poses = poses;
    solved.external_values = Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(poses.size()));
    solved.path = follow(robot, poses, solved.external_values);
    return solved;
}

Eigen::Matrix3Xd upwards(const SolvedPath& solved)
{
    return Vector3d::UnitZ().replicate(1, static_cast<Eigen::Index>(solved.poses.size()));
}

struct Case {
    Case(Robot r, const PosePath& poses, const Workpiece* w = nullptr)
        : robot(std::move(r)), workpiece(w), solved(solve(robot, poses)),
          before(check_path(robot, workpiece, solved.path.joints, collision)), away(upwards(solved))
    {
    }
    AvoidedPath run(const AvoidOptions& options) const
    {
        return avoid(robot, workpiece, solved, before, away, options, collision);
    }
    static AvoidOptions smooth() { return {.smooth = true}; }

    Robot robot;
    const Workpiece* workpiece;
    CollisionOptions collision;
    SolvedPath solved;
    CheckedPath before;
    Eigen::Matrix3Xd away;
};

double largest_change(const std::vector<PoseChange>& changes)
{
    double most = 0;
    for (std::size_t i = 1; i < changes.size(); ++i)
        most = std::max(most, tilt_between(changes[i - 1].tilt, changes[i].tilt));
    return most;
}

int colliding(const CheckedPath& checked, const CollisionOptions& options)
{
    int count = 0;
    for (std::size_t i = 0; i < checked.pose.size(); ++i)
        count += checked.pose[i].clearance < -options.tolerance || checked.between[i].clearance < -options.tolerance;
    return count;
}

// A square plate at a height, 40 mm wide about (x, 0).
Mesh plate(double x, double z)
{
    Mesh mesh;
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
    const double pivot = tilt_pivot(with_tool({}));
    EXPECT_EQ(pivot, kBall);
    for (int i = 0; i < 1000; ++i) {
        const Isometry3d pose = Eigen::Translation3d(1000 * any(random), any(random), any(random)) *
                                Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
        const PoseChange change{0.5 * Vector2d(any(random), any(random)), 0};
        const Isometry3d tilted = changed_pose(pose, change, pivot, Vector3d::UnitZ());
        // The ball stays, so it touches with whatever normal where it did.
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
    Robot robot = irb1400();
    EXPECT_EQ(tilt_pivot(robot), 0);
    robot.bodies = {{"flat", link::kTool, solid::Cylinder{{0, 0, 0}, {0, 0, 50}, 5}},
                    {"knob", link::kTool, solid::Sphere{{0, 0, 60}, 8}}};
    EXPECT_EQ(tilt_pivot(robot), 0);
    robot.bodies.push_back({"round", link::kTool, solid::Capsule{{0, 0, 40}, {0, 0, 5}, 5}});
    EXPECT_EQ(tilt_pivot(robot), 5);
}

// The rod is `deep` in a wall. A tilt by an angle away from it moves the rod's low end, nearest to the pivot and so the
// last to come free, by (kRodLow - kBall) times its sine.
TEST(Avoid, FirstConeThatIsClear)
{
    for (const double deep : {3.0, 12.0, 25.0, 40.0}) {
        const Case c(with_tool({wall(kRod - deep)}), along_x(1000, 1));
        EXPECT_NEAR(c.before.pose[0].clearance, -deep, 1e-4);
        const AvoidedPath avoided = c.run({});
        const double needed = std::asin((deep - c.collision.tolerance) / (kRodLow - kBall));
        const double cone = std::ceil(needed / (5 * kDegree)) * 5;
        EXPECT_NEAR(avoided.changes[0].tilt.norm() / kDegree, cone, 1e-9) << deep;
        EXPECT_EQ(avoided.changes[0].retreat, 0);
        EXPECT_GE(avoided.checked.pose[0].clearance, -c.collision.tolerance);
        EXPECT_LT(avoided.poses[0].linear()(1, 2), 0); // away from the wall
        EXPECT_EQ(avoided.path.state[0], PoseState::reached);
        // The joints lead to the pose.
        const Isometry3d reached = Arm(c.robot).flange(avoided.path.joints.col(0).head<6>()) * c.robot.T_flange_tool;
        EXPECT_LT((reached.matrix() - avoided.poses[0].matrix()).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(Avoid, BeyondTheLargestTiltNothingHelps)
{
    const double deep = 80; // asin(80 / 94) is more than 45 degrees
    const Case c(with_tool({wall(kRod - deep)}), along_x(1000, 1));
    for (const AvoidOptions& options : {AvoidOptions(), Case::smooth()}) {
        const AvoidedPath avoided = c.run(options);
        EXPECT_EQ(avoided.changes[0].tilt.norm(), 0);
        EXPECT_TRUE(avoided.poses[0].isApprox(c.solved.poses[0], 0));
        EXPECT_EQ(avoided.checked.pose[0].clearance, c.before.pose[0].clearance);
    }
    AvoidOptions wider;
    wider.most_tilt = 70 * kDegree;
    EXPECT_NEAR(c.run(wider).changes[0].tilt.norm() / kDegree, 60, 1e-9);
}

// A ball that is 0.25 mm deep in the workpiece: no tilt helps, the third step back does.
TEST(Avoid, Retreats)
{
    const Mesh mesh = plate(1000, 500.25);
    const Workpiece workpiece(mesh);
    const Case c(with_tool({}), along_x(1000, 1), &workpiece);
    EXPECT_NEAR(c.before.pose[0].clearance, -0.25, 1e-9);
    const AvoidedPath avoided = c.run({});
    EXPECT_EQ(avoided.changes[0].tilt.norm(), 0);
    EXPECT_NEAR(avoided.changes[0].retreat, 0.3, 1e-12);
    EXPECT_NEAR(avoided.checked.pose[0].clearance, 0.05, 1e-9);
    EXPECT_NEAR(avoided.poses[0].translation().z(), 500.3, 1e-9);
    AvoidOptions near;
    near.most_retreat = 0.2;
    EXPECT_EQ(c.run(near).changes[0], PoseChange());
}

TEST(Avoid, WhatIsClearStaysToTheLastBit)
{
    const Case c(with_tool({wall(500)}), along_x(1000, 20));
    for (const AvoidOptions& options : {AvoidOptions(), Case::smooth()}) {
        const AvoidedPath avoided = c.run(options);
        EXPECT_EQ(avoided.path.joints, c.solved.path.joints);
        for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(avoided.changes[i], PoseChange());
    }
}

// Along a wall that begins and ends beside the path: pose by pose the tool jerks, smoothly it leans early.
TEST(Avoid, SmoothChangesLittle)
{
    const Case c(with_tool({wall(kRod - 15, 50)}), along_x(800, 400));
    const AvoidedPath by_pose = c.run({}), smooth = c.run(Case::smooth());
    EXPECT_GE(largest_change(by_pose.changes), 4.99 * kDegree); // from cone to cone at least
    EXPECT_LE(largest_change(smooth.changes), 0.3 * largest_change(by_pose.changes));
    EXPECT_EQ(colliding(smooth.checked, c.collision), 0);
    EXPECT_TRUE(smooth.path.jumps.empty());
    EXPECT_EQ(smooth.changes.front(), PoseChange());
    EXPECT_EQ(smooth.changes.back(), PoseChange());
    // No more tilt than is needed, but for the last steps between tilts.
    double most = 0;
    for (const PoseChange& change : smooth.changes) most = std::max(most, change.tilt.norm());
    EXPECT_NEAR(most, std::asin(15 / (kRodLow - kBall)), 0.5 * kDegree);
    // What is told of the changed path is what a look at it tells.
    const CheckedPath again = check_path(c.robot, nullptr, smooth.path.joints, c.collision);
    for (std::size_t i = 0; i < again.pose.size(); ++i)
        EXPECT_EQ(again.pose[i].clearance, smooth.checked.pose[i].clearance);
}

TEST(Avoid, PosesThatTheArmCannotReachUpright)
{
    // At the end of its reach the tool must lean outwards or the wrist is too far away.
    Robot robot = with_tool({});
    SolvedPath solved = solve(robot, along_x(1500, 300));
    std::size_t unreached = 0;
    for (const PoseState state : solved.path.state) unreached += state == PoseState::reached ? 0 : 1;
    ASSERT_GT(unreached, 0u);
    const Case c(robot, along_x(1500, 300));
    const AvoidedPath avoided = c.run({});
    std::size_t left = 0;
    for (const PoseState state : avoided.path.state) left += state == PoseState::reached ? 0 : 1;
    EXPECT_LT(left, unreached);
    EXPECT_TRUE(avoided.path.jumps.empty());
    // The other way round there is no pose before to begin from; as many are reached.
    PosePath back = along_x(1500, 300);
    std::reverse(back.begin(), back.end());
    const AvoidedPath inwards = Case(robot, back).run({});
    EXPECT_NEAR(
        static_cast<double>(std::count(inwards.path.state.begin(), inwards.path.state.end(), PoseState::reached)),
        static_cast<double>(300 - left), 5);
}

// Whatever is passed over as known to collide does collide.
TEST(Blocked, NeverPassesOverWhatIsClear)
{
    const Case c(with_tool({wall(kRod - 15)}), along_x(1000, 1));
    const Trials trials(c.robot, nullptr, c.collision, c.solved, c.away);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-0.8, 0.8);
    const auto change = [&] { return PoseChange{{any(random), any(random)}, std::abs(any(random))}; };
    Blocked known;
    for (int i = 0; i < 20; ++i) trials.look(0, change(), trials.near(0), known);
    int passed_over = 0;
    for (int i = 0; i < 2000; ++i) {
        const PoseChange tried = change();
        if (!known.holds(tried)) continue;
        ++passed_over;
        Blocked fresh;
        EXPECT_TRUE(trials.look(0, tried, trials.near(0), fresh).hasNaN());
    }
    EXPECT_GT(passed_over, 200);
}

TEST(LayeredSearch, AgreesWithAllWays)
{
    std::mt19937 random(3);
    std::uniform_int_distribution<int> length(0, 9), fault(0, 5);
    for (int round = 0; round < 200; ++round) {
        constexpr std::size_t kLayers = 4, kStations = 4;
        LayeredSearch::Length way[kLayers][kStations][kStations];
        LayeredSearch search;
        for (std::size_t k = 0; k < kLayers; ++k) {
            for (auto& from : way[k])
                for (auto& to : from) to = {fault(random) == 0 ? 1 : 0, double(length(random))};
            search.add(kStations, [&](std::size_t from, std::size_t to) { return way[k][from][to]; });
        }
        const auto total = [&](const std::vector<std::size_t>& path) {
            LayeredSearch::Length sum = way[0][0][path[0]];
            for (std::size_t k = 1; k < kLayers; ++k) {
                sum.faults += way[k][path[k - 1]][path[k]].faults;
                sum.length += way[k][path[k - 1]][path[k]].length;
            }
            return sum;
        };
        LayeredSearch::Length least{1000, 0};
        for (std::size_t n = 0; n < 256; ++n) least = std::min(least, total({n & 3, n >> 2 & 3, n >> 4 & 3, n >> 6}));
        EXPECT_EQ(total(search.path()), least);
        EXPECT_EQ(search.path().back(), search.best());
    }
}

// Two walls beside one path. The tool leans past the first one, may not jump back, and so passes the second one.
TEST(Avoid, HandsATiltOnToTheNextWall)
{
    const auto beside = [](const char* name, double least_x, double most_x) {
        const Vector3d least(least_x, kRod - 15, 560), most(most_x, 1500, 900);
        return Body{name, link::kCell,
                    solid::Box{Isometry3d(Eigen::Translation3d((least + most) / 2)), (most - least) / 2}};
    };
    const Case c(with_tool({beside("first", 850, 905), beside("second", 980, 1050)}), along_x(900, 100));
    EXPECT_GT(c.before.pose[40].clearance, 5); // between them
    AvoidOptions options;
    options.jump = 2 * kDegree;
    const AvoidedPath avoided = c.run(options);
    EXPECT_EQ(colliding(avoided.checked, c.collision), 0);
    EXPECT_GT(avoided.changes[0].tilt.norm(), 0);
    for (const PoseChange& change : avoided.changes) EXPECT_EQ(change, avoided.changes[0]);
}

// A fin between two poses, higher than any retreat: the ends of the way are where they were.
TEST(Avoid, TakesBackRetreatsThatDoNotHelp)
{
    Mesh fin;
    fin.vertices.resize(3, 3);
    fin.vertices << 1025, 1025, 1025, -20, 20, 0, 480, 480, 560;
    fin.triangles = Eigen::Vector3i(0, 1, 2);
    const Workpiece workpiece(fin);
    const PosePath poses = {Isometry3d(Eigen::Translation3d(1000, 0, 500)),
                            Isometry3d(Eigen::Translation3d(1050, 0, 500))};
    const Case c(with_tool({}), poses, &workpiece);
    ASSERT_GT(c.before.pose[0].clearance, 0);
    ASSERT_GT(c.before.pose[1].clearance, 0);
    ASSERT_LT(c.before.between[1].clearance, 0);
    const AvoidedPath avoided = c.run({});
    EXPECT_EQ(avoided.path.joints, c.solved.path.joints);
    for (const PoseChange& change : avoided.changes) EXPECT_EQ(change, PoseChange());
    EXPECT_LT(avoided.checked.between[1].clearance, 0);
}

TEST(Avoid, RetreatsAlongNormals)
{
    const Isometry3d on_its_side(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()));
    const PosePath poses(4, on_its_side);
    Cloud cloud;
    cloud.xyz.setZero(3, 4);
    const Vector3d axis = -Vector3d::UnitY();
    EXPECT_LT((retreat_directions(cloud, poses).colwise() - axis).norm(), 1e-12);
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, 4);
    normals.col(0) << 0, 3, 4;
    normals.col(2).setConstant(std::numeric_limits<double>::quiet_NaN());
    normals.col(3) << 1, 0, 0;
    set_normals(cloud, normals);
    Eigen::Matrix3Xd expected = axis.replicate(1, 4);
    expected.col(0) << 0, 0.6, 0.8;
    expected.col(3) << 1, 0, 0;
    EXPECT_LT((retreat_directions(cloud, poses) - expected).norm(), 1e-6);
}

} // namespace

} // namespace fettle
