#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>

/// Wall-clock and processor time, ms.
struct Spent {
    double wall = std::numeric_limits<double>::infinity(), cpu = wall;
};

template <typename Work>
Spent time_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    benchmark::DoNotOptimize(work());
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    return {wall.count(), 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

/// Times two ways in turn, so that their ratio tells something on a busy machine too.
///   ours_ms, library_ms   the fastest of the iterations, wall clock
///   library_of_ours       library_ms / ours_ms: ours stays where the tool that uses it is 1.3 times as fast
///   cpu_library_of_ours   the same of processor time
template <typename Ours, typename Library>
void race(benchmark::State& state, const Ours& ours, const Library& library)
{
    Spent best_ours, best_library;
    const auto keep = [](Spent& best, const Spent& now) {
        best = {std::min(best.wall, now.wall), std::min(best.cpu, now.cpu)};
    };
    for (auto _ : state) {
        keep(best_ours, time_of(ours));
        keep(best_library, time_of(library));
    }
    state.counters["ours_ms"] = best_ours.wall;
    state.counters["library_ms"] = best_library.wall;
    state.counters["library_of_ours"] = best_library.wall / best_ours.wall;
    state.counters["cpu_library_of_ours"] = best_library.cpu / best_ours.cpu;
}
