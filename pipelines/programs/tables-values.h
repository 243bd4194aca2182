#pragma once

// Measurements of the programs tables-*.cc, lines "NAME VALUE", read back by the programs that evaluate them.

#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace fettle::study {

using Values = std::map<std::string, std::vector<double>>;

inline Values read_values(const std::string& path)
{
    const std::string text = core::read_file(path);
    Values values;
    for (core::Lines lines(text); lines.next();) {
        const std::vector<std::string_view> both = core::words(lines.line());
        const std::optional<double> value = both.size() == 2 ? core::parse_number(both[1]) : std::nullopt;
        if (!value) throw core::InputError(core::display_name(path), lines.location() + ": expected NAME VALUE");
        values[std::string(both[0])].push_back(*value);
    }
    return values;
}

/// @throws InputError if nothing of that name was measured
inline const std::vector<double>& measured(const Values& values, const std::string& name)
{
    const auto found = values.find(name);
    if (found == values.end()) throw core::InputError("nothing was measured for " + name);
    return found->second;
}

inline double mean(const std::vector<double>& x)
{
    double sum = 0;
    for (const double value : x) sum += value;
    return sum / static_cast<double>(x.size());
}

inline double deviation(const std::vector<double>& x)
{
    double squares = 0;
    for (const double value : x) squares += (value - mean(x)) * (value - mean(x));
    return x.size() < 2 ? 0 : std::sqrt(squares / static_cast<double>(x.size() - 1));
}

/// Interpolated between the ranks.
inline double quantile(std::vector<double> x, double share)
{
    std::ranges::sort(x);
    const double rank = share * static_cast<double>(x.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    return std::lerp(x[below], x[std::min(below + 1, x.size() - 1)], rank - static_cast<double>(below));
}

// --- figure 4-8 ---

/// Radii of curvature of the saddles and areas of the square anomalies, in and in².
inline const std::vector<std::string> kRadii = {"25", "10", "7.5", "5"};
inline const std::vector<std::string> kSquares = {"1", "10.5625", "30.25", "60.0625", "100"};

/// Mean of the minimum number of estimated points over the area; squares for which 15 curves did not always suffice are
/// left out.
inline std::vector<std::pair<double, double>> min_point_counts(const Values& values, const std::string& radius)
{
    std::vector<std::pair<double, double>> result;
    for (const std::string& square : kSquares) {
        const std::string name = "4-8/" + radius + "/" + square;
        if (!values.contains(name + "/none")) result.emplace_back(std::stod(square), mean(measured(values, name)));
    }
    return result;
}

/// s of the line 1 + s area through them, by least squares: Wang's 0.22 (2007, eq. 4-3), 1/in².
inline double points_per_area(const Values& values, const std::string& radius)
{
    double above = 0, below = 0;
    for (const auto& [area, number] : min_point_counts(values, radius)) {
        above += area * (number - 1);
        below += area * area;
    }
    return above / below;
}

} // namespace fettle::study
