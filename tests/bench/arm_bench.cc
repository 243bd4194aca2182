// Forward and closed-form inverse kinematics of the IRB 1400, one core: poses a second. `all branches`: whatever the
// ranges.

#include "robot/arm.h"

#include "../lib/irb1400.h"

#include <benchmark/benchmark.h>

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

void inverse(benchmark::State& state, robot::Ranges ranges)
{
    const robot::Robot robot = irb1400();
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
BENCHMARK_CAPTURE(inverse, in range, robot::Ranges::respect)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(inverse, all branches, robot::Ranges::ignore)->Unit(benchmark::kMillisecond);

} // namespace
