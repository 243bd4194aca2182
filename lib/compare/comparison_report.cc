#include "compare/comparison_report.h"

#include "core/text.h"
#include "json/units.h"

#include <cmath>
#include <ostream>
#include <string>
#include <utility>

namespace fettle::compare {

namespace {

/// A member of the report, in units of length to the given power.
struct Member {
    const char* name;
    double geometry::Statistics::*value;
    int power;
};
constexpr Member kMembers[] = {{"mean", &geometry::Statistics::mean, 1},
                               {"mean_abs", &geometry::Statistics::mean_abs, 1},
                               {"rms", &geometry::Statistics::rms, 1},
                               {"sd", &geometry::Statistics::sd, 1},
                               {"min", &geometry::Statistics::min, 1},
                               {"max", &geometry::Statistics::max, 1},
                               {"band", &geometry::Statistics::band, 1},
                               {"p01", &geometry::Statistics::p01, 1},
                               {"p05", &geometry::Statistics::p05, 1},
                               {"p50", &geometry::Statistics::p50, 1},
                               {"p95", &geometry::Statistics::p95, 1},
                               {"p99", &geometry::Statistics::p99, 1},
                               {"within", &geometry::Statistics::within, 0},
                               {"over_cut_area", &geometry::Statistics::over_cut_area, 2},
                               {"under_cut_area", &geometry::Statistics::under_cut_area, 2},
                               {"over_cut_volume", &geometry::Statistics::over_cut_volume, 3},
                               {"under_cut_volume", &geometry::Statistics::under_cut_volume, 3}};

struct PointMember {
    const char* name;
    Eigen::Vector3d geometry::Statistics::*value;
};
constexpr PointMember kPointMembers[] = {{"min_at", &geometry::Statistics::min_at},
                                         {"max_at", &geometry::Statistics::max_at}};

double in_units(const geometry::Statistics& s, const Member& member, const units::Units& units)
{
    return s.*member.value / std::pow(units.mm(), member.power);
}

json::Value to_json(const geometry::Histogram& histogram, const units::Units& units)
{
    json::Value value;
    value.set("limit", histogram.limit / units.mm()).set("below", histogram.below).set("above", histogram.above);
    value.set("counts", std::vector<json::Value>(histogram.counts.begin(), histogram.counts.end()));
    return value;
}

std::vector<std::pair<std::string, geometry::Statistics>> rows_of(const std::vector<Comparison>& comparisons)
{
    std::vector<std::pair<std::string, geometry::Statistics>> rows;
    for (const Comparison& comparison : comparisons) {
        const std::string prefix = rows.empty() ? "" : "reverse ";
        rows.emplace_back(prefix + "all", comparison.all);
        for (const auto& [name, statistics] : comparison.regions) rows.emplace_back(prefix + name, statistics);
    }
    return rows;
}

void set_members(json::Value& value, const geometry::Statistics& s, const units::Units& units)
{
    value.set("count", s.count).set("undefined", s.undefined);
    for (const Member& member : kMembers) value.set(member.name, in_units(s, member, units));
    for (const PointMember& point : kPointMembers) value.set(point.name, Eigen::VectorXd(s.*point.value / units.mm()));
}

} // namespace

json::Value to_json(const geometry::Statistics& s, const units::Units& units)
{
    json::Value value;
    set_members(value, s, units);
    return value;
}

json::Value to_json(const Comparison& comparison, const units::Units& units)
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

json::Value to_json(const ReferenceRepair& repair, const mesh::MeshRepair& reading, const units::Units& units)
{
    json::Value report;
    report.set("dropped_facets", reading.dropped_triangles).set("unused_vertices", reading.unused_vertices);
    report.set("weld_tolerance", repair.weld_tolerance / units.mm());
    report.set("welded_vertices", repair.welded_vertices);
    report.set("repeated_facets", repair.repeated_facets).set("opposite_facets", repair.opposite_facets);
    return report.set("flipped_facets", repair.flipped_facets);
}

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons, const units::Units& units)
{
    out << "points,count,undefined";
    for (const Member& member : kMembers) out << ',' << member.name;
    for (const PointMember& point : kPointMembers)
        for (const char* axis : {"_x", "_y", "_z"}) out << ',' << point.name << axis;
    out << '\n';
    for (const auto& [name, s] : rows_of(comparisons)) {
        out << name << ',' << s.count << ',' << s.undefined;
        for (const Member& member : kMembers) out << ',' << core::to_text(in_units(s, member, units));
        for (const PointMember& point : kPointMembers)
            for (const double coordinate : s.*point.value) out << ',' << core::to_text(coordinate / units.mm());
        out << '\n';
    }
}

void write_csv(std::ostream& out, const geometry::Histogram& histogram, const units::Units& units)
{
    const double limit = histogram.limit / units.mm();
    const double width = 2 * limit / histogram.counts.size();
    out << "from,to,count\n-inf," << core::to_text(-limit) << ',' << histogram.below << '\n';
    for (std::size_t i = 0; i < histogram.counts.size(); ++i)
        out << core::to_text(-limit + width * i) << ',' << core::to_text(-limit + width * (i + 1)) << ','
            << histogram.counts[i] << '\n';
    out << core::to_text(limit) << ",inf," << histogram.above << '\n';
}

} // namespace fettle::compare
