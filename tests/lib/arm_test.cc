#include "robot/arm.h"

#include "irb1400.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace fettle {
namespace arm_test {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
    const double turn = (a.linear() - b.linear()).norm() / std::sqrt(2.0); // of a small one its angle, rad
    return std::max((a.translation() - b.translation()).norm(), turn);
}

// Largest difference but for whole turns.
double difference(const robot::Joints& a, const robot::Joints& b)
{
    return (a - b).unaryExpr([](double d) { return std::abs(std::remainder(d, 2 * std::numbers::pi)); }).maxCoeff();
}

robot::Joints random_joints(const robot::Robot& robot, std::mt19937& random)
{
    robot::Joints q;
    for (std::size_t i = 0; i < 6; ++i)
        q[static_cast<Eigen::Index>(i)] =
            std::uniform_real_distribution<double>(robot.dh[i].range.min, robot.dh[i].range.max)(random);
    return q;
}

// An arm with every freedom that the closed form has: offsets of the axes, either sense of the twists, a bent flange.
robot::Robot random_arm(std::mt19937& random)
{
    robot::Robot robot = irb1400(random() % 2 == 0 ? robot::Coupling::serial : robot::Coupling::parallelogram);
    std::normal_distribution<double> normal;
    const auto sign = [&] { return random() % 2 == 0 ? 1.0 : -1.0; };
    for (robot::DhRow& row : robot.dh) row.offset = normal(random);
    for (const std::size_t i : {0u, 2u, 3u, 4u}) robot.dh[i].alpha = sign() * std::numbers::pi / 2;
    robot.dh[0] = {robot.dh[0].alpha, 100 * normal(random), 400, robot.dh[0].offset, robot.dh[0].range, {}};
    robot.dh[1].a = sign() * (500 + 100 * std::abs(normal(random)));
    robot.dh[1].d = 40 * normal(random);
    robot.dh[2].a = 100 * normal(random);
    robot.dh[2].d = 40 * normal(random);
    robot.dh[3].d = sign() * 700;
    robot.dh[5].a = 50 * normal(random);
    robot.dh[5].alpha = normal(random);
    return robot;
}

Eigen::Isometry3d flange_at(const robot::Robot& robot, const robot::Joints& q) { return robot::Arm(robot).flange(q); }

void expect_at(const robot::Robot& robot, const robot::Joints& q, double x, double y, double z)
{
    EXPECT_LT((flange_at(robot, q).translation() - Eigen::Vector3d(x, y, z)).norm(), 1e-9) << q.transpose() / kDegree;
}

// Reference: the arm drawn by hand in its plane: 150 out and 475 up to axis 2, 600 along the upper arm, 120 across and
// 720 + 85 along the forearm. 955, 0, 1195 is the maker's home.
TEST(Arm, PosesByHand)
{
    const robot::Robot robot = irb1400();
    const double s30 = 0.5, c30 = std::sqrt(0.75);
    expect_at(robot, degrees(0, 0, 0, 0, 0, 0), 955, 0, 1195);
    expect_at(robot, degrees(90, 0, 0, 0, 0, 0), 0, 955, 1195);
    expect_at(robot, degrees(-30, 0, 0, 0, 0, 0), 955 * c30, -955 * s30, 1195);
    // joint 2 leans the upper arm forward, the forearm stays level
    expect_at(robot, degrees(0, 30, 0, 0, 0, 0), 150 + 600 * s30 + 805, 0, 475 + 600 * c30 + 120);
    // joint 3 lowers the forearm
    expect_at(robot, degrees(0, 0, 30, 0, 0, 0), 150 + 120 * s30 + 805 * c30, 0, 475 + 600 + 120 * c30 - 805 * s30);
    expect_at(robot, degrees(0, 0, 0, 0, 90, 0), 150 + 720, 0, 1195 - 85);
    expect_at(robot, degrees(0, 0, 0, 90, 90, 0), 150 + 720, 85, 1195);
    expect_at(irb1400(robot::Coupling::serial), degrees(0, 30, 0, 0, 0, 0), 150 + 600 * s30 + 120 * s30 + 805 * c30, 0,
              475 + 600 * c30 + 120 * c30 - 805 * s30);
    // the paper's tool reaches 200 out of the flange and 100 down; +z of the path's frame points back to the holder
    const Eigen::Isometry3d tip = flange_at(robot, degrees(0, 0, 0, 0, 0, 0)) * robot.T_flange_tool;
    EXPECT_LT((tip.translation() - Eigen::Vector3d(1155, 0, 1095)).norm(), 1e-9);
    EXPECT_LT((tip.linear().col(2) + Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

// Table 1 as it is printed, theta = q, does not give the home pose of the robot.
TEST(Arm, PrintedTableHasAnotherZero)
{
    robot::Robot printed = irb1400(robot::Coupling::serial);
    printed.dh[1].offset = 0;
    EXPECT_GT((flange_at(printed, robot::Joints::Zero()).translation() - Eigen::Vector3d(955, 0, 1195)).norm(), 1000);
}

// Every solution brings the flange back, one of them by the joints that it came from. Within 1e-5 of a singularity the
// joints themselves are uncertain (roundings over the distance), the pose is not.
void expect_round_trips(const robot::Robot& robot, int count, std::mt19937& random, robot::Ranges ranges)
{
    const robot::Arm arm(robot);
    double worst_pose = 0, worst_joints = 0;
    int missed = 0;
    for (int i = 0; i < count; ++i) {
        const robot::Joints q = random_joints(robot, random);
        const Eigen::Isometry3d flange = arm.flange(q);
        const robot::ArmSolutions solutions = arm.solve(flange, robot::Joints::Zero(), ranges);
        double nearest = INFINITY;
        for (const robot::ArmSolution& solution : solutions) {
            worst_pose = std::max(worst_pose, difference(arm.flange(solution.joints), flange));
            nearest = std::min(nearest, difference(solution.joints, q));
            if (ranges == robot::Ranges::respect && !arm.in_range(solution.joints)) ++missed;
        }
        if (arm.singularity(q).min() < 1e-5) continue;
        worst_joints = std::max(worst_joints, nearest);
        if (nearest > 1e-9) ++missed;
        for (std::size_t a = 0; a < solutions.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                if (difference(solutions.solutions[a].joints, solutions.solutions[b].joints) < 1e-6) ++missed;
    }
    EXPECT_EQ(missed, 0);
    EXPECT_LE(worst_pose, 1e-9);
    EXPECT_LE(worst_joints, 1e-9);
    testing::Test::RecordProperty("worst_pose", std::to_string(worst_pose * 1e12) + "e-12");
    testing::Test::RecordProperty("worst_joints", std::to_string(worst_joints * 1e12) + "e-12");
}

TEST(Arm, RoundTripsOfAMillionPoses)
{
    std::mt19937 random(1);
    expect_round_trips(irb1400(), 1000000, random, robot::Ranges::respect);
}

TEST(Arm, RoundTripsOfAnyArm)
{
    std::mt19937 random(2);
    for (int k = 0; k < 100; ++k) {
        const robot::Robot robot = random_arm(random);
        expect_round_trips(robot, 500, random, robot::Ranges::ignore);
        expect_round_trips(robot, 500, random, robot::Ranges::respect);
    }
}

// All roots that Newton's method finds from many starts; twist of the flange by differences.
std::vector<robot::Joints> roots(const robot::Arm& arm, const Eigen::Isometry3d& flange, int starts,
                                 std::mt19937& random)
{
    std::uniform_real_distribution<double> turn(-std::numbers::pi, std::numbers::pi);
    constexpr double kScale = 700; // mm a rad, so that lengths and turns weigh alike
    const auto miss = [&](const robot::Joints& q) {
        const Eigen::Isometry3d T = arm.flange(q);
        const Eigen::Matrix3d E = T.linear() * flange.linear().transpose();
        robot::Joints e;
        e << (T.translation() - flange.translation()) / kScale, (E(2, 1) - E(1, 2)) / 2, (E(0, 2) - E(2, 0)) / 2,
            (E(1, 0) - E(0, 1)) / 2;
        return e;
    };
    std::vector<robot::Joints> found;
    for (int s = 0; s < starts; ++s) {
        robot::Joints q = robot::Joints::NullaryExpr([&] { return turn(random); });
        for (int step = 0; step < 60; ++step) {
            const robot::Joints e = miss(q);
            if (e.norm() < 1e-13) break;
            Matrix6d J;
            for (Eigen::Index k = 0; k < 6; ++k) J.col(k) = (miss(q + 1e-6 * robot::Joints::Unit(k)) - e) / 1e-6;
            robot::Joints d = J.partialPivLu().solve(e);
            q -= d * std::min(1.0, 0.7 / d.norm());
        }
        if (!(difference(arm.flange(q), flange) < 1e-7)) continue; // also half a turn has no miss
        const auto same = [&q](const robot::Joints& other) { return difference(other, q) < 1e-5; };
        if (std::none_of(found.begin(), found.end(), same)) found.push_back(q);
    }
    return found;
}

// Reference: a search for roots independent of the closed form. None is missed, none is spurious.
TEST(Arm, AsManySolutionsAsThereAreRoots)
{
    std::mt19937 random(3);
    int max = 0, fewest = 8;
    for (int k = 0; k < 24; ++k) {
        const robot::Robot robot = k < 12 ? irb1400() : random_arm(random);
        const robot::Arm arm(robot);
        const robot::Joints q = random_joints(robot, random);
        if (arm.singularity(q).min() < 0.05) continue; // where roots are near each other Newton crawls
        const Eigen::Isometry3d flange = arm.flange(q);
        const robot::ArmSolutions solutions = arm.solve(flange, robot::Joints::Zero(), robot::Ranges::ignore);
        const std::vector<robot::Joints> found = roots(arm, flange, 400, random);
        EXPECT_EQ(found.size(), solutions.size()) << k;
        for (const robot::Joints& root : found)
            EXPECT_TRUE(std::any_of(solutions.begin(), solutions.end(), [&](const robot::ArmSolution& s) {
                return difference(s.joints, root) < 1e-6;
            })) << k;
        max = std::max(max, static_cast<int>(solutions.size()));
        fewest = std::min(fewest, static_cast<int>(solutions.size()));
    }
    EXPECT_EQ(max, 8);
    EXPECT_EQ(fewest, 4); // the arm cannot reach over its head
}

// The determinant of the Jacobian at the wrist centre is a2 L (|a2| + L) times the three distances, by central
// differences of the forward kinematics.
TEST(Arm, SingularityIsTheJacobiansDeterminant)
{
    std::mt19937 random(4);
    for (int k = 0; k < 200; ++k) {
        robot::Robot robot = random_arm(random);
        robot.dh[1].d = robot.dh[2].d = 0;
        robot.dh[5].a = robot.dh[5].d = 0; // the flange is at the wrist centre
        const robot::Arm arm(robot);
        const robot::Joints q = random_joints(robot, random);
        Matrix6d J;
        const double h = 1e-5;
        for (Eigen::Index i = 0; i < 6; ++i) {
            const Eigen::Isometry3d after = arm.flange(q + h * robot::Joints::Unit(i)),
                                    before = arm.flange(q - h * robot::Joints::Unit(i));
            const Eigen::Matrix3d W = after.linear() * before.linear().transpose() / (4 * h);
            J.col(i) << (after.translation() - before.translation()) / (2 * h), W(2, 1) - W(1, 2), W(0, 2) - W(2, 0),
                W(1, 0) - W(0, 1);
        }
        const double a2 = std::abs(robot.dh[1].a), L = std::hypot(robot.dh[2].a, robot.dh[3].d);
        const robot::Singularity s = arm.singularity(q);
        const double expected = a2 * L * (a2 + L) * s.shoulder * s.elbow * s.wrist;
        EXPECT_NEAR(std::abs(J.determinant()), expected, 1e-6 * a2 * L * (a2 + L));
    }
}

// Where the joints are not determined, those near the ones given are taken, and the pose is met.
TEST(Arm, SingularPosesAreSolved)
{
    const robot::Robot robot = irb1400();
    const robot::Arm arm(robot);
    const robot::Joints straight = degrees(20, 10, -15, 40, 0, -70);
    const robot::ArmSolutions wrist = arm.solve(arm.flange(straight), straight, robot::Ranges::respect);
    ASSERT_GT(wrist.size(), 0u);
    EXPECT_LT(difference(wrist.solutions[0].joints, straight), 1e-9);
    for (const robot::ArmSolution& s : wrist) EXPECT_LT(difference(arm.flange(s.joints), arm.flange(straight)), 1e-9);
    EXPECT_NEAR(arm.singularity(straight).wrist, 0, 1e-12);

    // the wrist centre over axis 1: across = 0 at q2 = -70 needs L cos(..) = 150 + 600 sin(-70 deg) undone
    robot::Joints above = degrees(25, -70, 0, 10, 60, 30);
    const double L = std::hypot(120, 720), phi = std::atan2(-720, -120);
    above[2] = -std::acos((-150 + 600 * std::cos(20 * kDegree)) / L) - phi - 90 * kDegree;
    ASSERT_LT(arm.singularity(above).shoulder, 1e-12);
    const robot::ArmSolutions shoulder = arm.solve(arm.flange(above), above, robot::Ranges::ignore);
    ASSERT_GT(shoulder.size(), 0u);
    for (const robot::ArmSolution& s : shoulder) EXPECT_LT(difference(arm.flange(s.joints), arm.flange(above)), 1e-8);

    // the arm stretched: both elbows are one
    robot::Joints stretched = degrees(0, 30, 0, 20, 40, 60);
    stretched[2] = stretched[1] + std::numbers::pi - phi;
    ASSERT_LT(arm.singularity(stretched).elbow, 1e-12);
    const robot::ArmSolutions elbow = arm.solve(arm.flange(stretched), robot::Joints::Zero(), robot::Ranges::ignore);
    ASSERT_GT(elbow.size(), 0u);
    for (const robot::ArmSolution& s : elbow) EXPECT_LT(difference(arm.flange(s.joints), arm.flange(stretched)), 1e-9);
    Eigen::Isometry3d beyond = arm.flange(stretched);
    const Eigen::Vector3d wrist_centre = beyond.translation() - beyond.linear() * Eigen::Vector3d(0, 0, 85);
    const Eigen::Vector3d axis2(150, 0, 475);
    beyond.translation() += 1e-6 * (wrist_centre - axis2).normalized();
    EXPECT_FALSE(arm.solve(beyond, robot::Joints::Zero(), robot::Ranges::ignore).reachable);
}

TEST(Arm, ReportsJointRanges)
{
    const robot::Robot robot = irb1400();
    const robot::Arm arm(robot);
    const robot::Joints at_the_end = degrees(170, 70, -65, -150, 115, 300);
    const robot::ArmSolutions solutions =
        arm.solve(arm.flange(at_the_end), robot::Joints::Zero(), robot::Ranges::respect);
    EXPECT_TRUE(std::any_of(solutions.begin(), solutions.end(),
                            [&](const robot::ArmSolution& s) { return difference(s.joints, at_the_end) < 1e-9; }));
    const robot::Joints beyond = degrees(0, 0, 75, 0, 30, 0);
    const robot::ArmSolutions none = arm.solve(arm.flange(beyond), robot::Joints::Zero(), robot::Ranges::respect);
    EXPECT_TRUE(none.reachable);
    for (const robot::ArmSolution& s : none) EXPECT_GT(difference(s.joints, beyond), 1e-3);
}

} // namespace arm_test
} // namespace fettle
