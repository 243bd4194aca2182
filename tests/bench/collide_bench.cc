// A ball-end tool, 0.02 mm clear of a wavy sheet of 100,000 and of a million triangles, leaning up to 15 degrees:
// signed clearance of each part of it by itself, one core. And pairs of solids.

#include "robot/workpiece.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

using namespace fettle;

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

double height(double x, double y) { return 20 * std::cos(x / 100) * std::cos(y / 60) + 0.5 * std::sin(x / 8); }

Mesh sheet(Eigen::Index triangles)
{
    const auto n = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 2));
    Mesh mesh;
    mesh.vertices.resize(3, (n + 1) * (n + 1));
    mesh.triangles.resize(3, 2 * n * n);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = 300.0 * i / n - 150, y = 120.0 * j / n - 60;
            mesh.vertices.col(j * (n + 1) + i) << x, y, height(x, y);
        }
    Eigen::Index t = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.col(t++) << a, b, d;
            mesh.triangles.col(t++) << a, d, c;
        }
    return mesh;
}

/// Along lines over the sheet; the origin is the ball's centre, z the tool's axis.
std::vector<Isometry3d> poses()
{
    std::vector<Isometry3d> all;
    for (int k = 0; k < 2000; ++k) {
        const double x = -140 + 280 * (k % 200 + 0.5) / 200, y = -50 + 100 * (k / 200 + 0.5) / 10, e = 1e-4;
        const Vector3d n = Vector3d((height(x - e, y) - height(x + e, y)) / (2 * e),
                                    (height(x, y - e) - height(x, y + e)) / (2 * e), 1)
                               .normalized();
        Isometry3d T = Isometry3d::Identity();
        T.translation() = Vector3d(x, y, height(x, y)) + 6.02 * n;
        T.linear() =
            Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), 0.2 * n + 0.8 * Vector3d::UnitZ()).toRotationMatrix();
        all.push_back(T);
    }
    return all;
}

void tool(benchmark::State& state, const Solid& solid)
{
    const Mesh mesh = sheet(state.range(0));
    const Workpiece workpiece(mesh);
    const std::vector<Isometry3d> all = poses();
    for (auto _ : state)
        for (const Isometry3d& T : all) benchmark::DoNotOptimize(workpiece.nearest(PlacedSolid(solid, T), 50));
    state.counters["poses/s"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(all.size()), benchmark::Counter::kIsRate);
}
const Solid kBall = solid::Sphere{{0, 0, 0}, 6};
const Solid kShank = solid::Cylinder{{0, 0, 0}, {0, 0, 40}, 5};
const Solid kSpindle = solid::Cylinder{{0, 0, 40}, {0, 0, 130}, 45};
BENCHMARK_CAPTURE(tool, ball, kBall)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tool, shank, kShank)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tool, spindle, kSpindle)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);

/// Solids of some 20 mm, placed at random in a cube of `range` mm: the smaller, the more overlap.
void pairs(benchmark::State& state, const Solid& a, const Solid& b)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> at(-1, 1);
    std::normal_distribution<double> normal;
    std::vector<PlacedSolid> first, second;
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
        for (std::size_t k = 0; k < first.size(); ++k) benchmark::DoNotOptimize(clearance(first[k], second[k]));
    state.counters["pairs/s"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(first.size()), benchmark::Counter::kIsRate);
}
const Solid kCapsule = solid::Capsule{{0, 0, -10}, {0, 0, 10}, 5};
const Solid kCylinder = solid::Cylinder{{0, 0, -10}, {0, 0, 10}, 8};
const Solid kBox = solid::Box{Isometry3d::Identity(), {10, 8, 5}};
BENCHMARK_CAPTURE(pairs, capsules, kCapsule, kCapsule)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pairs, boxes, kBox, kBox)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pairs, cylinders, kCylinder, kCylinder)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pairs, cylinder and box, kCylinder, kBox)->Arg(100)->Arg(10)->Unit(benchmark::kMicrosecond);

} // namespace
