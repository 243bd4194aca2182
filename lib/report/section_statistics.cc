#include "compare/statistics.h"
#include "report/charts.h"
#include "report/figures.h"
#include "report/sections.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

struct Row {
    const char* key;
    const char* name;
    int power; ///< of length; 0: a count; -1: a share
};
constexpr Row kRows[] = {{"count", "Points with an error", 0},
                         {"undefined", "Undefined", 0},
                         {"mean", "Mean", 1},
                         {"mean_abs", "Mean size", 1},
                         {"rms", "Root mean square", 1},
                         {"sd", "Standard deviation", 1},
                         {"min", "Least (over-cut)", 1},
                         {"p01", "1st percentile", 1},
                         {"p05", "5th percentile", 1},
                         {"p50", "Median", 1},
                         {"p95", "95th percentile", 1},
                         {"p99", "99th percentile", 1},
                         {"max", "Most (material left)", 1},
                         {"band", "Error band", 1},
                         {"within", "Within tolerance", -1},
                         {"over_cut_area", "Over-cut area", 2},
                         {"under_cut_area", "Under-cut area", 2},
                         {"over_cut_volume", "Over-cut volume", 3},
                         {"under_cut_volume", "Under-cut volume", 3}};

std::string name_of(const std::string& region)
{
    if (region == "inside") return "Inside B";
    if (region == "around") return "Around, S\u2216B";
    if (region == "outside") return "Outside";
    return "All points";
}

Html statistics_table(const ComparisonReport& comparison, const std::string& unit)
{
    double largest = 0, area = 0, volume = 0;
    std::vector<Html> names = {""};
    for (const auto& [region, numbers] : comparison.regions) {
        names.emplace_back(name_of(region));
        largest = std::max({largest, -numbers.at("min"), numbers.at("max")});
        area = std::max({area, numbers.at("over_cut_area"), numbers.at("under_cut_area")});
        volume = std::max({volume, numbers.at("over_cut_volume"), numbers.at("under_cut_volume")});
    }
    std::rotate(names.begin() + 1, names.begin() + 2, names.end()); // all points last
    const int decimals = decimals_for(largest);
    std::vector<std::vector<Html>> rows;
    for (const Row& row : kRows) {
        const std::string units = row.power == 1   ? ", " + unit
                                  : row.power == 2 ? ", " + unit + "\u00B2"
                                  : row.power == 3 ? ", " + unit + "\u00B3"
                                                   : "";
        if (row.power == -1 && std::isnan(comparison.regions.front().second.at(row.key)))
            continue; // without a tolerance nothing is within one
        std::vector<Html> cells = {row.name + units};
        for (const auto& [region, numbers] : comparison.regions) {
            const std::string key = "comparison." + (region == "all" ? "" : "regions." + region + ".") + row.key;
            const double value = numbers.at(row.key);
            const std::string text = row.power == 0    ? count_text(value)
                                     : row.power == -1 ? fixed_text(100 * value, 2) + " %"
                                     : row.power == 1  ? fixed_text(value, decimals)
                                                      : fixed_text(value, decimals_for(row.power == 2 ? area : volume));
            cells.push_back(figure(key, value, text));
        }
        std::rotate(cells.begin() + 1, cells.begin() + 2, cells.end());
        rows.push_back(cells);
    }
    return table("Errors: + material left (under-cut), \u2212 over-cut", names, rows, 1);
}

/// The histogram of what is judged, if the error map is there to be counted, else of all points.
Html histogram(const RunFiles& run)
{
    const ComparisonReport& c = *run.comparison;
    if (c.counts.empty()) return {};
    const std::string unit = to_string(run.units.length);
    if (!run.errors || !run.job)
        return drawing_with_caption(error_histogram(c.counts, c.limit, c.below, c.above, c.tolerance, unit),
                                    "Histogram of all points; the tolerance dashed.");
    const Eigen::VectorXd errors = field(*run.errors, "error");
    const std::vector<Region> places = regions(*run.job, run.errors->xyz);
    Eigen::VectorXd inside = errors;
    for (Eigen::Index i = 0; i < errors.size(); ++i)
        if (places[static_cast<std::size_t>(i)] != Region::inside) inside[i] = std::numeric_limits<double>::quiet_NaN();
    Histogram counted(c.limit * run.units.mm(), static_cast<int>(c.counts.size()));
    counted.add(inside);
    const std::vector<double> counts(counted.counts.begin(), counted.counts.end());
    return drawing_with_caption(
        error_histogram(counts, c.limit, double(counted.below), double(counted.above), c.tolerance, unit),
        "Histogram of the points inside B; the tolerance dashed.");
}

} // namespace

Html statistics_section(const RunFiles& run)
{
    if (!run.comparison) return {};
    return section("statistics", "Statistics",
                   statistics_table(*run.comparison, to_string(run.units.length)) + histogram(run));
}

} // namespace fettle
