// The elastic layer under a wheel that rolls along a wavy ground: contacts a second on a grid of 64 x 64 cells, each
// begun from the two before it (to 1e-6 and 1e-4) or from nothing.

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

LayerContact layer() { return {{10, 5, 0.45}, {kCell, kCell}, kCells, kCells}; }

void rolling(benchmark::State& state)
{
    LayerContact contact = layer();
    const double tolerance = std::pow(10, -static_cast<double>(state.range(0)));
    constexpr int kSteps = 64;
    std::vector<MatrixXd> gaps;
    for (int step = 0; step < kSteps; ++step) gaps.push_back(gap(step));
    MatrixXd last = contact.by_force(gaps[0], 30, tolerance).pressure, now = last;
    int step = 0;
    for (auto _ : state) {
        const Contact next = contact.by_force(gaps[std::size_t(step++ % kSteps)], 30, tolerance, 2 * now - last);
        last = std::move(now);
        now = next.pressure;
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(rolling)->Arg(6)->Arg(4)->Unit(benchmark::kMillisecond);

void cold(benchmark::State& state)
{
    LayerContact contact = layer();
    const MatrixXd ground = gap(0);
    for (auto _ : state) benchmark::DoNotOptimize(contact.by_force(ground, 30, 1e-6).force);
}
BENCHMARK(cold)->Unit(benchmark::kMillisecond);

} // namespace
