// One fit of 30 touches, `auto` (families weighed against each other): of a sphere, a cylinder, a saddle, a hull whose
// curvature grows, and a wave, which no family explains. And adaptive probing with 30 touches: 23 fits, and as many
// choices.

#include "fit/fit.h"
#include "margin/adaptive.h"
#include "sampling/noise.h"

#include <benchmark/benchmark.h>

#include <cmath>

using namespace fettle;

namespace {

using Truth = double (*)(double, double);

double sphere(double x, double y) { return std::sqrt(200.0 * 200 - x * x - y * y); }
double cylinder(double x, double y) { return std::sqrt(200.0 * 200 - std::pow(0.8 * x + 0.6 * y, 2)); }
double saddle(double x, double y) { return (x * x - y * y) / 400; }
double hull(double x, double y) { return -(x * x + y * y / 3) / 400 * (1 + x / 200); }
double wave(double x, double y) { return cylinder(x, y) + 0.5 * std::sin(x / 15 + 0.4 * y / 15); }

constexpr double kSide = 80; // mm

/// An anomaly half as wide as the square about it.
job::Job job()
{
    job::Job result;
    result.anomaly.resize(3, 4);
    result.anomaly << -kSide, kSide, kSide, -kSide, -kSide, -kSide, kSide, kSide, 0, 0, 0, 0;
    result.anomaly /= 4;
    result.sampling = 2 * result.anomaly;
    return result;
}

/// Touches all over the square but for the anomaly, 99 % of them within 0.127 mm.
fit::FitInput touches_of(Truth truth, int count)
{
    fit::FitInput input;
    input.job = job();
    input.xyz.resize(3, count);
    input.roles = Eigen::VectorXi::Ones(count);
    const Eigen::VectorXd noise =
        sampling::draw_noise({sampling::TouchNoise::Kind::normal, input.job.probe.accuracy}, count, 1);
    int n = 0;
    for (int i = 1; n < count; ++i) { // additive recurrence of the plastic number: even, and never in rows
        const double x = kSide * (std::fmod(0.5 + 0.7548776662466927 * i, 1) - 0.5);
        const double y = kSide * (std::fmod(0.5 + 0.5698402909980532 * i, 1) - 0.5);
        if (std::max(std::abs(x), std::abs(y)) < kSide / 4) continue;
        input.xyz.col(n) << x, y, truth(x, y) + noise[n];
        ++n;
    }
    return input;
}

void fit(benchmark::State& state, Truth truth)
{
    const fit::FitInput input = touches_of(truth, static_cast<int>(state.range(0)));
    std::string method;
    for (auto _ : state) method = fit::fit_surface(input, "auto").surface.method;
    state.SetLabel(method);
}
BENCHMARK_CAPTURE(fit, sphere, sphere)->Arg(30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit, cylinder, cylinder)->Arg(30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit, saddle, saddle)->Arg(30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit, hull, hull)->Arg(30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit, wave, wave)->Arg(30)->Unit(benchmark::kMillisecond);

void adaptive(benchmark::State& state, Truth truth)
{
    const job::Job anywhere = job();
    margin::AdaptiveLimits limits;
    limits.max_touches = static_cast<int>(state.range(0));
    const auto probe = [&](const sampling::TouchPlan& plan) {
        Eigen::Matrix3Xd touches(3, plan.size());
        const Eigen::VectorXd noise =
            sampling::draw_noise({sampling::TouchNoise::Kind::normal, anywhere.probe.accuracy}, plan.size(), 1);
        for (Eigen::Index i = 0; i < plan.size(); ++i)
            touches.col(i) << plan.xy.col(i), truth(plan.xy(0, i), plan.xy(1, i)) + noise[i];
        return touches;
    };
    for (auto _ : state) benchmark::DoNotOptimize(margin::touch_adaptively(anywhere, limits, probe).touches);
}
BENCHMARK_CAPTURE(adaptive, sphere, sphere)->Arg(30)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(adaptive, wave, wave)->Arg(30)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
