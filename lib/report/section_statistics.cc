#include "core/constants.h"
#include "draw/figures.h"
#include "geometry/statistics.h"
#include "job/region.h"
#include "report/charts.h"
#include "report/sections.h"

#include <algorithm>
#include <cmath>

namespace fettle::report {
namespace {

struct Row {
    const char* key;
    const char* name;
    int power; ///< power of length; 0: a count; -1: a fraction
};
constexpr Row kRows[] = {{"count", "Points with an error", 0},
                         {"undefined", "Undefined", 0},
                         {"mean", "Mean", 1},
                         {"mean_abs", "Mean absolute error", 1},
                         {"rms", "Root mean square", 1},
                         {"sd", "Standard deviation", 1},
                         {"min", "Minimum (over-cut)", 1},
                         {"p01", "1st percentile", 1},
                         {"p05", "5th percentile", 1},
                         {"p50", "Median", 1},
                         {"p95", "95th percentile", 1},
                         {"p99", "99th percentile", 1},
                         {"max", "Maximum (material left)", 1},
                         {"band", "Error band", 1},
                         {"within", "Within tolerance", -1},
                         {"over_cut_area", "Over-cut area", 2},
                         {"under_cut_area", "Under-cut area", 2},
                         {"over_cut_volume", "Over-cut volume", 3},
                         {"under_cut_volume", "Under-cut volume", 3}};

std::string region_name(const std::string& region)
{
    if (region == "inside") return "Inside B";
    if (region == "around") return "Around, S\u2216B";
    if (region == "outside") return "Outside";
    return "All points";
}

draw::Html statistics_table(const ComparisonReport& comparison, const std::string& unit)
{
    double largest = 0, area = 0, volume = 0;
    std::vector<draw::Html> names = {""};
    for (const auto& [region, numbers] : comparison.regions) {
        names.emplace_back(region_name(region));
        largest = std::max({largest, -numbers.at("min"), numbers.at("max")});
        area = std::max({area, numbers.at("over_cut_area"), numbers.at("under_cut_area")});
        volume = std::max({volume, numbers.at("over_cut_volume"), numbers.at("under_cut_volume")});
    }
    std::rotate(names.begin() + 1, names.begin() + 2, names.end()); // all points last
    const int decimals = draw::decimals_for(largest);
    std::vector<std::vector<draw::Html>> rows;
    for (const Row& row : kRows) {
        const std::string units = row.power == 1   ? ", " + unit
                                  : row.power == 2 ? ", " + unit + "\u00B2"
                                  : row.power == 3 ? ", " + unit + "\u00B3"
                                                   : "";
        if (row.power == -1 && std::isnan(comparison.regions.front().second.at(row.key))) continue; // no tolerance
        std::vector<draw::Html> cells = {row.name + units};
        for (const auto& [region, numbers] : comparison.regions) {
            const std::string key = "comparison." + (region == "all" ? "" : "regions." + region + ".") + row.key;
            const double value = numbers.at(row.key);
            const std::string text = row.power == 0    ? draw::count_text(value)
                                     : row.power == -1 ? draw::fixed_text(100 * value, 2) + " %"
                                     : row.power == 1
                                         ? draw::fixed_text(value, decimals)
                                         : draw::fixed_text(value, draw::decimals_for(row.power == 2 ? area : volume));
            cells.push_back(draw::number_element(key, value, text));
        }
        std::rotate(cells.begin() + 1, cells.begin() + 2, cells.end());
        rows.push_back(cells);
    }
    return table("Errors: + material left (under-cut), \u2212 over-cut", names, rows, 1);
}

/// Where nine tenths of the points inside B lie.
std::string middle_text(const ComparisonReport& comparison, const std::string& unit)
{
    for (const auto& [region, numbers] : comparison.regions) {
        const double low = numbers.at("p05"), high = numbers.at("p95");
        if (region != "inside" || !std::isfinite(low)) continue;
        const int decimals = draw::decimals_for(std::max(std::abs(low), std::abs(high)));
        return " Nine of ten points lie between " + draw::fixed_text(low, decimals) + " and " +
               draw::fixed_text(high, decimals) + " " + unit + ".";
    }
    return {};
}

/// Histogram of the points inside B if the run has an error map and a job, else of all points.
draw::Html histogram(const RunFiles& run)
{
    const ComparisonReport& c = *run.comparison;
    if (c.counts.empty()) return {};
    const std::string unit = units::to_string(run.units.length);
    if (!run.errors || !run.job)
        return drawing_with_caption(error_histogram(c.counts, c.limit, c.below, c.above, c.tolerance, unit),
                                    "Histogram of all points; dashed lines: the tolerance.");
    const Eigen::VectorXd errors = cloud::field(*run.errors, "error");
    const std::vector<job::Region> point_regions = job::classify_regions(*run.job, run.errors->xyz);
    Eigen::VectorXd inside = errors;
    for (Eigen::Index i = 0; i < errors.size(); ++i)
        if (point_regions[i] != job::Region::inside) inside[i] = core::kNaN;
    geometry::Histogram counted(c.limit * run.units.mm(), c.counts.size());
    counted.add(inside);
    const std::vector<double> counts(counted.counts.begin(), counted.counts.end());
    return drawing_with_caption(
        error_histogram(counts, c.limit, double(counted.below), double(counted.above), c.tolerance, unit),
        "Histogram of the points inside B; dashed lines: the tolerance." + middle_text(c, unit));
}

} // namespace

draw::Html statistics_section(const RunFiles& run)
{
    if (!run.comparison) return {};
    return section("statistics", "Statistics",
                   statistics_table(*run.comparison, units::to_string(run.units.length)) + histogram(run));
}

} // namespace fettle::report
