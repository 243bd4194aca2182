// How honest the prediction of the next pass is: series of passes drawn from a hidden law, each predicted from those
// before.
//
//     law-series LAW SERIES SEED       a line a series, CSV
//
// LAW is one of
//     preston      F n t, scatter 5 %
//     power        F^2.3 n^1.75 t^1.4, scatter 12 %
//     tails        preston with a scatter of 6 %, Student's t with 4 degrees of freedom
//     threshold    (F - 1 N)^1.2 n t, scatter 8 %
//     wearing      F^1.3 n t, scatter 8 %, wears to 1/e in 100 to 400 passes, and the level wanders by 3 % a pass
// A series has 30 passes with forces of 3 to 9 N, 7,000 to 10,000 revolutions a minute, 5 to 20 s, and then one of a
// belt half as sharp.
#include "calibrate/law_record.h"
#include "calibrate/law_report.h"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <random>
#include <string>

using namespace fettle;

namespace {

constexpr int kPasses = 30;

struct HiddenLaw {
    std::string name;
    double force, speed, duration, threshold, scatter, drift;
    bool has_heavy_tails, wears;
};
const HiddenLaw kLaws[] = {{"preston", 1, 1, 1, 0, 0.05, 0, false, false},
                           {"power", 2.3, 1.75, 1.4, 0, 0.12, 0, false, false},
                           {"tails", 1, 1, 1, 0, 0.06, 0, true, false},
                           {"threshold", 1.2, 1, 1, 1, 0.08, 0, false, false},
                           {"wearing", 1.3, 1, 1, 0, 0.08, 0.03, false, true}};

/// Passes of a law; the last one with a belt half as sharp.
calibrate::LawRecord draw_series(const HiddenLaw& law, std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    std::student_t_distribution<double> student(4);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    calibrate::LawRecord record;
    const double life = law.wears ? uniform(100, 400) : std::numeric_limits<double>::infinity();
    double level = uniform(-12, -8), work = 0, mean_work = 6 * 8500 * 12.5;
    for (int k = 0; k <= kPasses; ++k) {
        const double F = uniform(3, 9), n = uniform(7000, 10000), t = uniform(5, 20);
        level += law.drift * normal(random);
        const double noise = law.scatter * (law.has_heavy_tails ? student(random) : normal(random));
        const double log_volume = level + law.force * std::log(F - law.threshold) + law.speed * std::log(n) +
                                  law.duration * std::log(t) - work / mean_work / life + noise -
                                  (k == kPasses ? std::log(2.0) : 0);
        record.passes.push_back({F, n, std::numeric_limits<double>::quiet_NaN(), t, work, std::exp(log_volume)});
        work += F * n * t;
    }
    const removal::RemovalTrial& first = record.passes.front();
    record.pass_work = first.force * first.speed * first.duration;
    return record;
}

void print_series(const HiddenLaw& law, int series, const calibrate::LearntLaw& learnt)
{
    calibrate::LearntLaw before = learnt; // without the last pass
    before.passes.pop_back();
    const calibrate::PredictionQuality quality = calibrate::prediction_quality(before);
    std::cout << law.name << ',' << series << ',' << quality.judged << ',' << quality.covered << ',' << quality.changes
              << ',' << learnt.passes.back().has_change << ',' << quality.median_error << '\n';
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) {
        std::cerr << "law-series LAW SERIES SEED\n";
        return 2;
    }
    for (const HiddenLaw& law : kLaws) {
        if (law.name != argv[1]) continue;
        std::mt19937_64 random(std::strtoull(argv[3], nullptr, 10));
        std::cout << "law,series,judged,covered,alarms,told,median_error\n";
        const int count = std::atoi(argv[2]);
        for (int series = 0; series < count; ++series)
            print_series(law, series, calibrate::learn(draw_series(law, random)));
        return 0;
    }
    std::cerr << "law-series: no law " << argv[1] << '\n';
    return 2;
}
