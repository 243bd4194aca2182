// How many touches adaptive probing saves, and whether the band that it predicts when it stops is met: one kind of
// surface, many cells of the design of Wang's factorial experiment (2007, 4.5).
//
//     probing KIND CELLS SEED       a line a cell and design, CSV
//
// Wang's layout fitted by auto and by modified griddata, and what fettle-sample --strategy adaptive touches, fitted by
// auto after each share of Wang's touches; "stopped": adaptive as it stops by itself at a predicted 95 % band of the
// probe's accuracy. Every design touches the same surface; each has its own noise. Inches.
#include "cells.h"

#include "core/error.h"
#include "fit/fit.h"
#include "margin/adaptive.h"
#include "margin/error_band.h"
#include "sampling/noise.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace fettle;
using namespace cells;

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
// Shares of Wang's number of touches, percent.
constexpr int kShares[] = {20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100};
constexpr int kMinTouches = 6; // that a fit takes

/// A surface and the points at which its fits are evaluated.
struct Part {
    job::Job job;
    Truth truth;
    Eigen::Matrix2Xd grid; ///< inside B, mm
    Eigen::VectorXd exact; ///< mm
    std::uint64_t seed;    ///< of the touches' noise
};

/// Infinite without a surface.
double band_of(const Part& part, const fit::FitInput& input, const std::string& method)
{
    try {
        const Eigen::VectorXd errors =
            surface::heights(fit::fit_surface(input, method).surface, part.grid) - part.exact;
        if (!errors.hasNaN()) return margin::error_band(errors);
    } catch (const core::InputError&) {
        // these touches determine none
    }
    return std::numeric_limits<double>::infinity();
}

fit::FitInput first_of(const Part& part, const margin::AdaptiveTouches& found, Eigen::Index count)
{
    fit::FitInput input;
    input.job = part.job;
    input.xyz = found.touches.leftCols(count);
    input.roles = found.plan.role.head(count);
    return input;
}

margin::AdaptiveTouches adapt(const Part& part, int max, double band)
{
    margin::AdaptiveLimits limits;
    limits.max_touches = max;
    limits.max_band = band;
    return margin::touch_adaptively(part.job, limits, [&](const sampling::TouchPlan& plan) {
        Eigen::Matrix3Xd touches(3, plan.size());
        touches << plan.xy, heights_of(part.truth, plan.xy / kInch).transpose() +
                                sampling::draw_noise({sampling::TouchNoise::Kind::normal, part.job.probe.accuracy},
                                                     plan.size(), part.seed)
                                    .transpose();
        return touches;
    });
}

void study(const std::string& kind, int number, std::uint64_t seed)
{
    std::mt19937_64 random(seed * 1000003 + static_cast<std::uint64_t>(number));
    const Cell cell = draw_cell(number, random);
    Part part;
    part.truth = truth_of(kind, cell).first;
    fit::FitInput wang = wang_touches(cell, part.truth);
    part.job = wang.job;
    part.grid = inside(cell.a, cell.b, 31) * kInch;
    part.exact = heights_of(part.truth, part.grid / kInch);
    part.seed = random();
    const auto all = static_cast<int>(wang.xyz.cols());
    const auto print = [&](const std::string& design, Eigen::Index touches, double band, double predicted) {
        std::cout << kind << ',' << number << ',' << all << ',' << design << ',' << touches << ',' << band / kInch
                  << ',' << predicted / kInch << '\n';
    };
    wang.xyz.row(2) +=
        sampling::draw_noise({sampling::TouchNoise::Kind::normal, part.job.probe.accuracy}, all, random()).transpose();
    print("wang", all, band_of(part, wang, "auto"), kUndefined);
    fit::FitInput interpolated = wang;
    add_estimated(interpolated);
    print("griddata", all, band_of(part, interpolated, "griddata"), kUndefined);

    const margin::AdaptiveTouches found = adapt(part, all, 0);
    for (const int share : kShares) {
        const int count = std::max(kMinTouches, static_cast<int>(std::lround(share * all / 100.0)));
        print("adaptive" + std::to_string(share), count, band_of(part, first_of(part, found, count), "auto"),
              found.band[count - 1]);
    }
    constexpr int kMaxTouches = 60; // as fettle-sample
    const margin::AdaptiveTouches stopped = adapt(part, kMaxTouches, part.job.probe.accuracy);
    const Eigen::Index count = stopped.plan.size();
    print(stopped.band_reached ? "stopped" : "exhausted", count, band_of(part, first_of(part, stopped, count), "auto"),
          stopped.band[count - 1]);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) {
        std::cerr << "usage: probing KIND CELLS SEED\n";
        return 2;
    }
    std::cout << "kind,cell,wang,design,touches,band,predicted\n";
    for (int number = 0; number < std::atoi(argv[2]); ++number)
        study(argv[1], number, std::strtoull(argv[3], nullptr, 10));
}
