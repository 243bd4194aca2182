// Pairs of solids, one core; motions between poses far apart. Tools against a workpiece: tool_hull_bench.

#include "mesh/mesh_file.h"
#include "robot/clearance.h"
#include "robot/collision.h"
#include "robot/hull_points.h"

#include <benchmark/benchmark.h>

#include <algorithm>
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

/// Motions between random joints, far apart, and how many are decided in a second: FCL's piano, as its hull, on an arm
/// in FCL's flat.
void ways_of_a_piano(benchmark::State& state)
{
    constexpr double kScale = 2.5; // of an IRB 1400: its reach is then the flat's
    const mesh::Mesh flat = mesh::read_mesh("tests/data/fcl_env.obj", units::Units::Length::mm);
    const mesh::Mesh piano = mesh::read_mesh("tests/data/fcl_rob.obj", units::Units::Length::mm);
    robot::Robot arm = robot::read_robot("samples/robots/irb1400.json");
    for (robot::DhRow& row : arm.dh) {
        row.a *= kScale;
        row.d *= kScale;
    }
    arm.track.reset();
    arm.allowed.clear();
    arm.bodies = {{"piano", robot::link::kTool, robot::solid::Hull{robot::hull_points(piano.vertices)}}};
    const robot::Workpiece workpiece(flat);
    std::mt19937 random(1);
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 500);
    for (Eigen::Index i = 0; i < joints.cols(); ++i)
        for (Eigen::Index j = 0; j < 6; ++j) {
            const robot::DhRow& row = arm.dh[static_cast<std::size_t>(j)];
            joints(j, i) = std::uniform_real_distribution<double>(row.range.min, row.range.max)(random);
        }
    std::size_t colliding = 0;
    for (auto _ : state) {
        const robot::CheckedPath checked = robot::check_path(arm, &workpiece, joints, {});
        colliding = static_cast<std::size_t>(std::ranges::count_if(
            checked.between_poses, [](const robot::CellClearance& c) { return c.clearance < -0.01; }));
    }
    state.counters["colliding"] = static_cast<double>(colliding);
    state.counters["ways/s"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(joints.cols() - 1), benchmark::Counter::kIsRate);
}
BENCHMARK(ways_of_a_piano)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

} // namespace
