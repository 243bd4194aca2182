#include "compare/comparison_report.h"

#include "core/text.h"
#include "json/units.h"

#include <cmath>
#include <ostream>
#include <string>
#include <utility>

namespace fettle {

namespace {

/// A name and a number in the unit of a report; volumes have power 3.
struct Member {
    const char* name;
    double Statistics::*value;
    int power;
};
constexpr Member kMembers[] = {{"mean", &Statistics::mean, 1},
                               {"mean_abs", &Statistics::mean_abs, 1},
                               {"rms", &Statistics::rms, 1},
                               {"sd", &Statistics::sd, 1},
                               {"min", &Statistics::min, 1},
                               {"max", &Statistics::max, 1},
                               {"band", &Statistics::band, 1},
                               {"p01", &Statistics::p01, 1},
                               {"p05", &Statistics::p05, 1},
                               {"p50", &Statistics::p50, 1},
                               {"p95", &Statistics::p95, 1},
                               {"p99", &Statistics::p99, 1},
                               {"within", &Statistics::within, 0},
                               {"over_cut_area", &Statistics::over_cut_area, 2},
                               {"under_cut_area", &Statistics::under_cut_area, 2},
                               {"over_cut_volume", &Statistics::over_cut_volume, 3},
                               {"under_cut_volume", &Statistics::under_cut_volume, 3}};

struct Place {
    const char* name;
    Eigen::Vector3d Statistics::*value;
};
constexpr Place kPlaces[] = {{"min_at", &Statistics::min_at}, {"max_at", &Statistics::max_at}};

double in_units(const Statistics& s, const Member& member, const Units& units)
{
    return s.*member.value / std::pow(units.mm(), member.power);
}

json::Value to_json(const Histogram& histogram, const Units& units)
{
    json::Value value;
    value.set("limit", histogram.limit / units.mm()).set("below", histogram.below).set("above", histogram.above);
    value.set("counts", std::vector<json::Value>(histogram.counts.begin(), histogram.counts.end()));
    return value;
}

std::vector<std::pair<std::string, Statistics>> rows_of(const std::vector<Comparison>& comparisons)
{
    std::vector<std::pair<std::string, Statistics>> rows;
    for (const Comparison& comparison : comparisons) {
        const std::string way = rows.empty() ? "" : "reverse ";
        rows.emplace_back(way + "all", comparison.all);
        for (const auto& [name, statistics] : comparison.regions) rows.emplace_back(way + name, statistics);
    }
    return rows;
}

void set_members(json::Value& value, const Statistics& s, const Units& units)
{
    value.set("count", static_cast<std::size_t>(s.count)).set("undefined", static_cast<std::size_t>(s.undefined));
    for (const Member& member : kMembers) value.set(member.name, in_units(s, member, units));
    for (const Place& place : kPlaces) value.set(place.name, Eigen::VectorXd(s.*place.value / units.mm()));
}

} // namespace

json::Value to_json(const Statistics& s, const Units& units)
{
    json::Value value;
    set_members(value, s, units);
    return value;
}

json::Value to_json(const Comparison& comparison, const Units& units)
{
    json::Value report;
    report.set("kind", "comparison").set("units", json::to_json(units.length));
    set_members(report, comparison.all, units);
    json::Value regions;
    for (const auto& [name, statistics] : comparison.regions) regions.set(name, to_json(statistics, units));
    if (!comparison.regions.empty()) report.set("regions", regions);
    report.set("histogram", to_json(comparison.histogram, units));
    if (!std::isnan(comparison.reference_sigma)) report.set("reference_sigma", comparison.reference_sigma / units.mm());
    return report;
}

json::Value to_json(const ReferenceRepair& repair, const MeshRepair& reading, const Units& units)
{
    json::Value report;
    report.set("dropped_facets", static_cast<std::size_t>(reading.dropped_triangles));
    report.set("weld_tolerance", repair.weld_tolerance / units.mm());
    report.set("welded_vertices", static_cast<std::size_t>(repair.welded_vertices));
    report.set("repeated_facets", static_cast<std::size_t>(repair.repeated_facets));
    return report.set("flipped_facets", static_cast<std::size_t>(repair.flipped_facets));
}

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons, const Units& units)
{
    out << "points,count,undefined";
    for (const Member& member : kMembers) out << ',' << member.name;
    for (const Place& place : kPlaces)
        for (const char* axis : {"_x", "_y", "_z"}) out << ',' << place.name << axis;
    out << '\n';
    for (const auto& [name, s] : rows_of(comparisons)) {
        out << name << ',' << s.count << ',' << s.undefined;
        for (const Member& member : kMembers) out << ',' << to_text(in_units(s, member, units));
        for (const Place& place : kPlaces)
            for (const double coordinate : s.*place.value) out << ',' << to_text(coordinate / units.mm());
        out << '\n';
    }
}

void write_csv(std::ostream& out, const Histogram& histogram, const Units& units)
{
    const double limit = histogram.limit / units.mm();
    const double width = 2 * limit / static_cast<double>(histogram.counts.size());
    out << "from,to,count\n-inf," << to_text(-limit) << ',' << histogram.below << '\n';
    for (std::size_t i = 0; i < histogram.counts.size(); ++i)
        out << to_text(-limit + width * static_cast<double>(i)) << ','
            << to_text(-limit + width * static_cast<double>(i + 1)) << ',' << histogram.counts[i] << '\n';
    out << to_text(limit) << ",inf," << histogram.above << '\n';
}

} // namespace fettle
