// How fast the virtual gantries simulate: passes over a 3 x 3 in part, wheel of 1 in radius and 1/4 in width.

#include "../lib/gantry_stock.h"

#include "gantry/dynamic.h"
#include "gantry/quasi_static.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <memory>

using namespace fettle;

namespace {

constexpr double kInch = 25.4;

/// A 2 x 2 in anomaly, 3/8 in high with a round edge, on a plane.
removal::HeightField anomaly(double cell)
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-kInch, -kInch), Eigen::Vector2d(kInch, kInch));
    removal::HeightField field = removal::empty_height_field(box, {kInch / 8, kInch}, 0, cell);
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (Eigen::Index i = 0; i < field.columns(); ++i) {
            const double r = field.centre(i, j).norm() / kInch;
            field.z(i, j) = r < 1 ? 0.375 * kInch * std::sqrt(1 - r * r) : 0;
        }
    return field;
}

job::Job job()
{
    job::Job inch;
    inch.removal_coefficient = 2e-3 * kInch * kInch * kInch / 4.4482216152605;
    return inch;
}

/// Loops of 1 kHz.
gantry::Machine machine()
{
    gantry::Machine machine;
    const gantry::Drive drive = drive_of_80_kg(5);
    machine.axes = {drive, drive, drive};
    machine.c = drive;
    machine.head = {.damping = 0.9, .travel = 25, .lvdt = 0.001, .noise = 0.002, .stiffness = 900};
    machine.spindle = {.speed = 500, .power = 1e8, .inertia = 10, .tangential = 0.4, .side = 0.1};
    return machine;
}

using Make = std::function<std::unique_ptr<gantry::VirtualGantry>(const removal::HeightField&)>;

/// Zig-zag over B, layer by layer from the top, steps of 0.5 mm; counts strategy steps and simulated seconds.
void grind(benchmark::State& state, const Make& make)
{
    const double cell = static_cast<double>(state.range(0)) / 1000;
    const removal::HeightField stock = anomaly(cell);
    int64_t steps = 0;
    double seconds = 0;
    for (auto _ : state) {
        const std::unique_ptr<gantry::VirtualGantry> gantry = make(stock);
        double direction = 1;
        for (double z = 0.375 * kInch; z > 0; z -= 0.6)
            for (double x = -kInch; x <= kInch; x += 5.08, direction = -direction) {
                gantry->travel({x, -direction * kInch, z});
                for (double y = -kInch; y <= kInch; y += 0.5, ++steps) gantry->grind({x, direction * y, z}, kInch);
            }
        seconds += gantry->totals().grinding_time;
        benchmark::DoNotOptimize(gantry->totals().removed_volume);
    }
    state.counters["steps/s"] = benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsRate);
    state.counters["simulated s/s"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}

void quasi_static(benchmark::State& state)
{
    grind(state,
          [](const removal::HeightField& stock) { return std::make_unique<gantry::QuasiStaticGantry>(stock, job()); });
}
BENCHMARK(quasi_static)->ArgName("cell_um")->Arg(400)->Arg(200)->Arg(100)->Arg(50)->Unit(benchmark::kMillisecond);

void dynamic(benchmark::State& state)
{
    grind(state, [](const removal::HeightField& stock) {
        return std::make_unique<gantry::DynamicGantry>(stock, job(), machine());
    });
}
BENCHMARK(dynamic)->ArgName("cell_um")->Arg(400)->Arg(200)->Arg(100)->Arg(50)->Unit(benchmark::kMillisecond);

} // namespace
