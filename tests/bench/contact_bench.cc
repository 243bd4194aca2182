// The elastic layer under a wheel that rolls along a wavy ground: contacts a second on a grid of 64 x 64 cells, each
// begun from the two before it (to 1e-6 and 1e-4) or from nothing; the same under a wheel as wide as the grid, whose
// sides are free; the same by 64 x 64 x 8 finite elements, the first contact and the next ones on the same grid. And
// heights between surfels of a wavy ground, by Shepard's weights and by kriging: time, and the rms error in
// micrometres.

#include "belt/gridding.h"
#include "belt/layer_contact.h"

#include <benchmark/benchmark.h>

#include <cmath>

using namespace fettle;

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kCells = 64;
constexpr double kCell = 0.5; // mm

/// A wheel of 100 mm, 0.4 mm farther at each step, over a bar with waves of 3 µm.
MatrixXd gap(int step)
{
    MatrixXd result(kCells, kCells);
    for (Index j = 0; j < kCells; ++j)
        for (Index i = 0; i < kCells; ++i) {
            const double x = (double(i) - kCells / 2.0) * kCell, y = (double(j) - kCells / 2.0) * kCell;
            result(i, j) = x * x / 200 + y * y / 120 + 0.003 * std::sin((x + 0.4 * step) / 2) * std::cos(y / 3);
        }
    return result;
}

belt::LayerContact layer() { return {{10, 5, 0.45}, {kCell, kCell}, kCells, kCells}; }

void roll(benchmark::State& state, belt::LayerContact contact)
{
    const double tolerance = std::pow(10, -static_cast<double>(state.range(0)));
    constexpr int kSteps = 64;
    std::vector<MatrixXd> gaps;
    for (int step = 0; step < kSteps; ++step) gaps.push_back(gap(step));
    MatrixXd last = contact.solve_by_force(gaps[0], 30, tolerance).pressure, now = last;
    int step = 0;
    for (auto _ : state) {
        const belt::Contact next =
            contact.solve_by_force(gaps[std::size_t(step++ % kSteps)], 30, tolerance, 2 * now - last);
        last = std::move(now);
        now = next.pressure;
    }
    state.SetItemsProcessed(state.iterations());
}
void rolling(benchmark::State& state) { roll(state, layer()); }
BENCHMARK(rolling)->Arg(6)->Arg(4)->Unit(benchmark::kMillisecond);

/// To be compared with `rolling`: at most 1.5 times its time.
void rolling_with_sides(benchmark::State& state)
{
    const belt::ElasticLayer rubber{10, 5, 0.45};
    const belt::EdgeCompliance edges(rubber, 100, kCells * kCell);
    roll(state, {rubber, edges, {kCell, kCell}, kCells, kCells});
}
BENCHMARK(rolling_with_sides)->Arg(6)->Arg(4)->Unit(benchmark::kMillisecond);

void cold(benchmark::State& state)
{
    belt::LayerContact contact = layer();
    const MatrixXd ground = gap(0);
    for (auto _ : state) benchmark::DoNotOptimize(contact.solve_by_force(ground, 30, 1e-6).force);
}
BENCHMARK(cold)->Unit(benchmark::kMillisecond);

belt::LayerContact finite_elements()
{
    return {belt::layer_mesh({10, 5, 0.45}, 100, 100, {kCell, kCell}, kCells, 8), kCells};
}

void first_of_elements(benchmark::State& state)
{
    const MatrixXd ground = gap(0);
    for (auto _ : state) benchmark::DoNotOptimize(finite_elements().solve_by_force(ground, 30, 1e-8).force);
}
BENCHMARK(first_of_elements)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void next_of_elements(benchmark::State& state)
{
    belt::LayerContact contact = finite_elements();
    int step = 0;
    for (auto _ : state) benchmark::DoNotOptimize(contact.solve_by_force(gap(step++), 30, 1e-8).force);
}
BENCHMARK(next_of_elements)->Unit(benchmark::kMillisecond);

/// @param state.range(0)  surfels for each cell, hundredths
void gridding(benchmark::State& state, belt::Gridding method)
{
    const auto ground = [](double x, double y) {
        return (x * x + y * y) / 400 + 0.05 * std::sin(x / 2) * std::cos(y / 3);
    };
    const belt::ContactGrid cells{{kCell, kCell}, kCells, kCells};
    const double side = 1.2 * kCells * kCell;
    const auto count = static_cast<Index>(1.44 * kCells * kCells * static_cast<double>(state.range(0)) / 100);
    Eigen::Matrix3Xd points(3, count);
    for (Index i = 0; i < count; ++i) { // additive recurrence of the plastic number: even, and never in rows
        const double x = side * (std::fmod(0.7548776662466927 * double(i), 1) - 0.5);
        const double y = side * (std::fmod(0.5698402909980532 * double(i), 1) - 0.5);
        points.col(i) << x, y, ground(x, y);
    }
    MatrixXd heights;
    for (auto _ : state) heights = belt::interpolate_heights(cells, points, method).height;
    double squares = 0;
    for (Index j = 0; j < kCells; ++j)
        for (Index i = 0; i < kCells; ++i) {
            const Eigen::Vector2d at = cells.cell_center(i, j);
            squares += std::pow(heights(i, j) - ground(at.x(), at.y()), 2);
        }
    state.counters["rms_um"] = 1000 * std::sqrt(squares / (kCells * kCells));
}
BENCHMARK_CAPTURE(gridding, shepard, belt::Gridding::shepard)
    ->Arg(25)
    ->Arg(100)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(gridding, kriging, belt::Gridding::kriging)
    ->Arg(25)
    ->Arg(100)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond);

} // namespace
