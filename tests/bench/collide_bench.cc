// Pairs of solids, one core. Tools against a workpiece: tool_hull_bench.

#include "robot/clearance.h"

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

using namespace fettle;

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

/// Solids of some 20 mm, placed at random in a cube of `range` mm: the smaller, the more overlap.
void pairs(benchmark::State& state, const robot::Solid& a, const robot::Solid& b)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> at(-1, 1);
    std::normal_distribution<double> normal;
    std::vector<robot::PlacedSolid> first, second;
    const auto place = [&] {
        const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([&] { return normal(random); }).normalized();
        const Vector3d p = static_cast<double>(state.range(0)) * Vector3d::NullaryExpr([&] { return at(random); });
        return Isometry3d(Eigen::Translation3d(p) * Eigen::Quaterniond(q));
    };
    for (int k = 0; k < 1000; ++k) {
        first.emplace_back(a, place());
        second.emplace_back(b, place());
    }
    for (auto _ : state)
        for (std::size_t k = 0; k < first.size(); ++k) benchmark::DoNotOptimize(robot::clearance(first[k], second[k]));
    state.counters["pairs/s"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(first.size()), benchmark::Counter::kIsRate);
}
const robot::Solid kCapsule = robot::solid::Capsule{{0, 0, -10}, {0, 0, 10}, 5};
const robot::Solid kCylinder = robot::solid::Cylinder{{0, 0, -10}, {0, 0, 10}, 8};
const robot::Solid kBox = robot::solid::Box{Isometry3d::Identity(), {10, 8, 5}};
BENCHMARK_CAPTURE(pairs, capsules, kCapsule, kCapsule)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pairs, boxes, kBox, kBox)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pairs, cylinders, kCylinder, kCylinder)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pairs, cylinder and box, kCylinder, kBox)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);

} // namespace
