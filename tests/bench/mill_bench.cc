// How fast the height field is cut: 10M cells of 0.1 mm, 100,000 moves of 0.5 mm, a ball of radius 6 mm, by two
// threads. The zig-zag lies level, or on waves with slopes to 45 degrees; its passes along the rows or at 30 degrees to
// them.

#include "machining/cutter.h"
#include "machining/milling.h"

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

using namespace fettle;

namespace {

constexpr double kCell = 0.1, kHalf = 158.15; // 3163 cells in each direction
constexpr int kMoves = 100000;

removal::HeightField stock()
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-kHalf, -kHalf), Eigen::Vector2d(kHalf, kHalf));
    removal::HeightField field = removal::empty_height_field(box, {0, 0}, 0, kCell);
    field.z.setConstant(30);
    return field;
}

/// @param steepest  slope of the waves, 60 mm long
std::vector<machining::CutterMove> zig_zag(double steepest, double angle)
{
    constexpr double kStep = 0.5, kStepOver = 2, kExtent = 300, kWave = 60;
    const double k = 2 * 3.14159265358979 / kWave, c = std::cos(angle), s = std::sin(angle);
    const auto tip = [&](double u, double v) {
        return Eigen::Vector3d(c * u - s * v, s * u + c * v, 10 + steepest / k * std::sin(k * u) * std::cos(k * v / 3));
    };
    std::vector<machining::CutterMove> moves;
    double u = -kExtent / 2, v = -kExtent / 2, step = kStep;
    Eigen::Vector3d at = tip(u, v);
    while (static_cast<int>(moves.size()) < kMoves) {
        if (std::abs(u + step) > kExtent / 2) {
            v += kStepOver;
            step = -step;
        } else {
            u += step;
        }
        machining::CutterMove move;
        move.from = at;
        move.to = at = tip(u, v);
        move.feed = 50;
        moves.push_back(move);
    }
    return moves;
}

void cut(benchmark::State& state)
{
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    const removal::HeightField whole = stock();
    const auto moves =
        zig_zag(static_cast<double>(state.range(0)) / 10, static_cast<double>(state.range(1)) / 180 * 3.14159265358979);
    const machining::Cutter ball = machining::parse_cutter(state.range(2) == 0 ? "ball:12" : "bull:12,2");
    for (auto _ : state) {
        state.PauseTiming();
        removal::HeightField field = whole;
        state.ResumeTiming();
        benchmark::DoNotOptimize(machining::mill(field, ball, moves).back().volume);
    }
}
BENCHMARK(cut)
    ->ArgNames({"steepest_tenths", "angle_deg", "bull"})
    ->ArgsProduct({{0, 10}, {0, 30, 90}, {0}})
    ->Args({10, 30, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

} // namespace
