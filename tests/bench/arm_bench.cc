// Forward and closed-form inverse kinematics of the IRB 1400, one core: poses a second. `all branches`: whatever the
// ranges.

#include "robot/arm.h"

#include "../lib/irb1400.h"

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

using namespace fettle;

namespace {

std::vector<Joints> random_joints(const Robot& robot)
{
    std::mt19937 random(1);
    std::vector<Joints> joints(4096);
    for (Joints& q : joints)
        for (std::size_t i = 0; i < 6; ++i)
            q[static_cast<Eigen::Index>(i)] =
                std::uniform_real_distribution<double>(robot.dh[i].range.least, robot.dh[i].range.most)(random);
    return joints;
}

void forward(benchmark::State& state)
{
    const Robot robot = irb1400();
    const Arm arm(robot);
    const std::vector<Joints> joints = random_joints(robot);
    for (auto _ : state)
        for (const Joints& q : joints) benchmark::DoNotOptimize(arm.flange(q));
    state.counters["poses/s"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(joints.size()), benchmark::Counter::kIsRate);
}
BENCHMARK(forward)->Unit(benchmark::kMillisecond);

void inverse(benchmark::State& state, Ranges ranges)
{
    const Robot robot = irb1400();
    const Arm arm(robot);
    std::vector<Eigen::Isometry3d> flanges;
    for (const Joints& q : random_joints(robot)) flanges.push_back(arm.flange(q));
    std::size_t solutions = 0;
    for (auto _ : state)
        for (const Eigen::Isometry3d& T : flanges) solutions += arm.solve(T, Joints::Zero(), ranges).size();
    const double poses = static_cast<double>(state.iterations()) * static_cast<double>(flanges.size());
    state.counters["poses/s"] = benchmark::Counter(poses, benchmark::Counter::kIsRate);
    state.counters["branches/pose"] = static_cast<double>(solutions) / poses;
}
BENCHMARK_CAPTURE(inverse, in range, Ranges::respect)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(inverse, all branches, Ranges::ignore)->Unit(benchmark::kMillisecond);

} // namespace
