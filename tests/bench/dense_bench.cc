// Fits to scans of very many points: binary PCD to surface.

#include "cloud/point_source.h"
#include "fit/dense.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

using namespace fettle;

namespace {

/// A wavy piece of 100 x 100 mm, 0.05 mm of noise, one point in five 1 to 10 mm off.
std::string scan_file(std::size_t points)
{
    const std::string path = std::filesystem::temp_directory_path() / ("dense_bench." + std::to_string(points));
    std::ofstream out(path, std::ios::binary);
    out << "# units mm\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << points
        << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points << "\nDATA binary\n";
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> noise(0, 0.05);
    for (std::size_t i = 0; i < points; ++i) {
        const double x = 100 * uniform(random) - 50, y = 100 * uniform(random) - 50;
        double z = 300 - std::sqrt(40000 - x * x - y * y) + 0.5 * std::sin(x / 12) * std::cos(y / 15) + noise(random);
        if (uniform(random) < 0.2) z += 1 + 9 * uniform(random);
        const float xyz[] = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        out.write(reinterpret_cast<const char*>(xyz), sizeof xyz);
    }
    return path;
}

job::Job job()
{
    job::Job result;
    result.anomaly.resize(3, 4);
    result.anomaly << -20, 20, 20, -20, -20, -20, 20, 20, 0, 0, 0, 0;
    result.sampling = 2.5 * result.anomaly;
    return result;
}

void dense_fit(benchmark::State& state)
{
    const std::string path = scan_file(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        const cloud::CloudStream stream(path);
        benchmark::DoNotOptimize(fit::fit_dense(stream.points(), job(), {}, path).fit.surface.rms);
    }
    std::filesystem::remove(path);
}
BENCHMARK(dense_fit)->Arg(1000)->Arg(100000)->Arg(10000000)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
