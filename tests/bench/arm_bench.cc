// Forward and closed-form inverse kinematics of the IRB 1400, and the inverse of a UR5, whose axes 2, 3 and 4 are
// parallel, one core: poses a second. `all branches`: whatever the ranges.

#include "robot/arm.h"

#include "../lib/irb1400.h"

#include <benchmark/benchmark.h>

#include <numbers>
#include <random>
#include <vector>

using namespace fettle;

namespace {

std::vector<robot::Joints> random_joints(const robot::Robot& robot)
{
    std::mt19937 random(1);
    std::vector<robot::Joints> joints(4096);
    for (robot::Joints& q : joints)
        for (std::size_t i = 0; i < 6; ++i)
            q[static_cast<Eigen::Index>(i)] =
                std::uniform_real_distribution<double>(robot.dh[i].range.min, robot.dh[i].range.max)(random);
    return joints;
}

void forward(benchmark::State& state)
{
    const robot::Robot robot = irb1400();
    const robot::Arm arm(robot);
    const std::vector<robot::Joints> joints = random_joints(robot);
    for (auto _ : state)
        for (const robot::Joints& q : joints) benchmark::DoNotOptimize(arm.flange(q));
    state.counters["poses/s"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(joints.size()), benchmark::Counter::kIsRate);
}
BENCHMARK(forward)->Unit(benchmark::kMillisecond);

/// By the table that Universal Robots publish.
robot::Robot ur5()
{
    constexpr double kRight = std::numbers::pi / 2;
    robot::Robot robot;
    robot.arm_kind = robot::ArmKind::parallel_axes;
    robot.coupling = robot::Coupling::serial;
    const double rows[6][3] = {{0, 89.159, kRight}, {-425, 0, 0},        {-392.25, 0, 0},
                               {0, 109.15, kRight}, {0, 94.65, -kRight}, {0, 82.3, 0}}; // a, d, alpha
    for (std::size_t i = 0; i < 6; ++i) {
        robot.dh[i].a = rows[i][0];
        robot.dh[i].d = rows[i][1];
        robot.dh[i].alpha = rows[i][2];
        robot.dh[i].range = {-2 * std::numbers::pi, 2 * std::numbers::pi};
    }
    return robot;
}

void inverse(benchmark::State& state, const robot::Robot& robot, robot::Ranges ranges)
{
    const robot::Arm arm(robot);
    std::vector<Eigen::Isometry3d> flanges;
    for (const robot::Joints& q : random_joints(robot)) flanges.push_back(arm.flange(q));
    std::size_t solutions = 0;
    for (auto _ : state)
        for (const Eigen::Isometry3d& T : flanges) solutions += arm.solve(T, robot::Joints::Zero(), ranges).size();
    const double poses = static_cast<double>(state.iterations()) * static_cast<double>(flanges.size());
    state.counters["poses/s"] = benchmark::Counter(poses, benchmark::Counter::kIsRate);
    state.counters["branches/pose"] = static_cast<double>(solutions) / poses;
}
BENCHMARK_CAPTURE(inverse, in range, irb1400(), robot::Ranges::respect)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(inverse, all branches, irb1400(), robot::Ranges::ignore)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(inverse, UR5 all branches, ur5(), robot::Ranges::ignore)->Unit(benchmark::kMillisecond);

} // namespace
