#pragma once

// The guesses of tables-table about what Wang 2007 leaves open, each a row of ratios to the published figures.

#include "tables-report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace fettle::study {

struct Guess {
    std::string name, what;
};

inline const std::vector<Guess> kGuesses = {
    {"as-is", "as above"},
    {"none", "no noise"},
    {"normal", "noise normal, 99 % within 0.005 in"},
    {"sigma", "noise normal, sigma 0.005 in"},
    {"linear", "griddata 'linear'"},
    {"once", "interpolated once"},
    {"half", "sampled every 0.5 in"},
    {"coarse", "sampled every 0.7 in"},
    {"corners", "corners of S touched, too"},
    {"over-sampling", "errors over all of S"},
    {"largest", "largest |error|, not the band"},
    {"anywhere", "4-3: touches anywhere on their side"},
    {"anywhere-cubic", "  and one cubic a curve"},
    {"anywhere-coarse", "  and both, sampled every 0.7 in"},
    {"swapped", "4-14: numbers of eq. 4-5 swapped"},
    {"two", "4-14: two lines each way, always"},
    {"one", "4-14: one line each way, always"},
    {"two-over-sampling", "4-14: two lines, errors over all of S"},
    {"two-linear", "4-14: two lines, griddata 'linear'"},
};

inline std::string ratio(double value)
{
    std::array<char, 16> text;
    std::snprintf(text.data(), text.size(), "%7.2f", value);
    return text.data();
}

inline std::string guess_line(const Report& report, const Guess& guess)
{
    const auto median = [&](const std::string& name) {
        return quantile(report.of("guess/" + guess.name + "/" + name), 0.5);
    };
    std::string line = padded(guess.what, 40);
    for (const auto& [name, published] : {std::pair("3x6", .0827), {"3x4", .1213}, {"2x6", .1597}, {"2x4", .1670}})
        line += ratio(median(std::string("4-3/") + name) / published);
    std::vector<double> simple;
    for (const auto& [name, published] : {std::pair("concave_2x2", .1196),
                                          {"concave_1x1", .0506},
                                          {"convex_2x2", .0991},
                                          {"convex_1x1", .0497},
                                          {"saddle_2x2", .1658},
                                          {"saddle_1x1", .0615}})
        simple.push_back(median(std::string("simple/") + name) / published);
    line += ratio(*std::ranges::min_element(simple)) + ratio(*std::ranges::max_element(simple)) + ratio(median("gain"));
    line += number(median("area")).substr(1) + ratio(median("slimmer")) + ratio(median("farther"));
    return line;
}

/// One row a guess about what the paper leaves open: Table 4-3 and the right half of Table 4-5 over the published
/// figures, what the estimated points gain, the area term of the regression and figure 4-14 (a), (b).
inline void guesses(Report& report)
{
    report.words("\nWhat the paper leaves open, one guess at a time. Medians over the published figures: Table 4-3, 3 "
                 "x 6, 3 x 4, 2 x 6,");
    report.words("2 x 4; Table 4-5, least and largest of six; then what the estimated points gain (published 1.74), "
                 "the area term");
    report.words("of the concave band (.0031) and by what factor slimmer and farther change it (figure 4-14 (a), (b): "
                 "both above 1)");
    report.words(padded("", 40) + "    3x6    3x4    2x6    2x4    4-5   to    gain    area    (a)    (b)");
    for (const Guess& guess : kGuesses) report.words(guess_line(report, guess));
}

} // namespace fettle::study
