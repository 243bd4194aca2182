#include "report/tool_reports.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"

#include <algorithm>
#include <filesystem>

namespace fettle::report {
namespace {

double number_or_nan(json::Reader& reader, const std::string& key)
{
    return reader.has(key) && reader.is_null_or_missing(key) ? core::kNaN : reader.number(key);
}

NamedNumbers read_numbers(json::Reader& reader, std::initializer_list<const char*> keys)
{
    NamedNumbers numbers;
    for (const char* key : keys) numbers[key] = number_or_nan(reader, key);
    return numbers;
}

NamedNumbers read_statistics(json::Reader& reader)
{
    return read_numbers(reader, {"count", "undefined", "mean", "mean_abs", "rms", "sd", "min", "max", "band", "p01",
                                 "p05", "p50", "p95", "p99", "within", "over_cut_area", "under_cut_area",
                                 "over_cut_volume", "under_cut_volume"});
}

Eigen::Matrix4d read_matrix(json::Reader& reader)
{
    const Eigen::MatrixXd rows = reader.matrix("transform", 4);
    if (rows.rows() != 4) reader.refuse("transform", "expected 4 rows");
    return rows;
}

} // namespace

const NamedNumbers& ComparisonReport::region(const std::string& name) const
{
    return std::ranges::find(regions, name, &std::pair<std::string, NamedNumbers>::first)->second;
}

ComparisonReport read_comparison(json::Reader& reader)
{
    ComparisonReport report;
    report.regions.emplace_back("all", read_statistics(reader));
    if (std::optional<json::Reader> regions = reader.optional_object("regions"))
        for (const char* name : {"inside", "around", "outside"})
            if (std::optional<json::Reader> region = regions->optional_object(name))
                report.regions.emplace_back(name, read_statistics(*region));
    if (std::optional<json::Reader> histogram = reader.optional_object("histogram")) {
        report.limit = histogram->number("limit", core::Range::positive());
        report.below = histogram->number("below");
        report.above = histogram->number("above");
        const Eigen::VectorXd counts = histogram->vector("counts");
        report.counts.assign(counts.begin(), counts.end());
    }
    if (!reader.has("verdict")) return report;
    report.within = reader.choice("verdict", {"within", "out of tolerance"}) == "within";
    report.reversed = reader.has("reverse");
    report.judged = reader.choice("judged", {"all", "inside"});
    report.tolerance = reader.number("tolerance", core::Range::at_least(0));
    report.worst = number_or_nan(reader, "worst");
    if (report.judged == "inside" && (report.regions.size() == 1 || report.regions[1].first != report.judged))
        reader.refuse("judged", "there is no region 'inside'");
    return report;
}

AlignmentReport read_alignment(json::Reader& reader)
{
    const NamedNumbers numbers =
        read_numbers(reader, {"count", "overlap", "max_distance", "median", "p95", "rms", "determined"});
    AlignmentReport report{numbers, read_matrix(reader), reader.text_or("doubt", ""), {}};
    if (std::optional<json::Reader> next = reader.optional_object("next"); next && next->has("transform"))
        if (next->flag_or("nearly_as_good", false))
            report.other_place = {read_numbers(*next, {"turn_deg", "shift", "misfit"}), read_matrix(*next)};
    return report;
}

FormReport read_form(json::Reader& reader)
{
    FormReport report;
    report.form = reader.text("form");
    report.parameter = reader.text_or("parameter", "");
    report.numbers = read_numbers(reader, {"count", "dropped", "outliers", "least_squares", "minimum_zone"});
    std::optional<json::Reader> elements = reader.optional_object("elements");
    if (!elements) return report; // straightness of several sections
    json::Reader element = elements->object("least_squares");
    for (const char* key : {"centre", "point"})
        if (element.has(key)) report.place = element.vector(key, 3);
    for (const char* key : {"normal", "axis"})
        if (element.has(key)) report.direction = element.vector(key, 3);
    if (element.has("radius")) report.radius = element.number("radius");
    return report;
}

PlayedFrames read_frames(json::Reader reader, const std::string& path)
{
    reader.expect_kind("frames");
    PlayedFrames played{reader.text("shown"), {}};
    for (json::Reader& frame : reader.objects("frames")) {
        const std::string name = frame.text("picture");
        if (name.find('/') != std::string::npos) frame.refuse("picture", "is not a file beside this one: " + name);
        const std::string file = (std::filesystem::path(path).parent_path() / name).string();
        std::string png = core::read_file(file, core::kMaxJsonBytes);
        if (!png.starts_with("\x89PNG")) throw core::InputError(file, "is not a PNG");
        played.frames.push_back({frame.number("t", core::Range::at_least(0)), std::move(png)});
    }
    if (played.frames.empty()) reader.refuse("frames", "is empty");
    return played;
}

GrindReport read_grinding(json::Reader& reader)
{
    GrindReport report;
    if (!reader.has("finished")) reader.refuse("finished", "missing");
    report.finished = reader.flag_or("finished", false);
    report.numbers = read_numbers(reader, {"removed_volume", "machine_time", "grinding_time", "travel_time",
                                           "service_time", "layers", "coverings", "re_cuts", "raises", "passes",
                                           "steps", "peak_force", "touch_offs", "wheel_changes", "wheel_radius"});
    if (!reader.has("peak_at")) return report; // by an older fettle-grind
    report.peak_at = reader.vector("peak_at", 3);
    for (const char* key : {"peak_layer", "strokes", "contact_time", "in_range"})
        report.numbers[key] = reader.number(key, core::Range::at_least(0));
    return report;
}

} // namespace fettle::report
