#include "report/run_files.h"

#include "cloud/pcd.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "diff/diff.h"
#include "report/checksum.h"
#include "json/document.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

/// Reads a file once, for all that is told of it.
class Files {
  public:
    struct Content {
        std::string bytes, source;
    };
    Content read(const std::string& what, const std::string& path, std::size_t most = std::string::npos)
    {
        Content content = {read_whole(path, most), display_name(path)};
        known_.push_back({what, content.source, content.bytes.size(), sha256(content.bytes)});
        return content;
    }
    json::Reader json(const std::string& what, const std::string& path)
    {
        const Content content = read(what, path, kMostJson);
        return json::Reader::parse(content.bytes, content.source);
    }
    std::vector<SourceFile> known() && { return std::move(known_); }

  private:
    std::vector<SourceFile> known_;
};

double number_or_nan(json::Reader& reader, const std::string& key)
{
    return reader.has(key) && reader.is_null(key) ? kNaN : reader.number(key);
}

Figures statistics_of(json::Reader& reader)
{
    Figures numbers;
    for (const char* key :
         {"count", "undefined", "mean", "mean_abs", "rms", "sd", "min", "max", "band", "p01", "p05", "p50", "p95",
          "p99", "within", "over_cut_area", "under_cut_area", "over_cut_volume", "under_cut_volume"})
        numbers[key] = number_or_nan(reader, key);
    return numbers;
}

ComparisonReport comparison_of(json::Reader& reader)
{
    ComparisonReport report;
    report.regions.emplace_back("all", statistics_of(reader));
    if (std::optional<json::Reader> regions = reader.object_or_none("regions"))
        for (const char* name : {"inside", "around", "outside"})
            if (std::optional<json::Reader> region = regions->object_or_none(name))
                report.regions.emplace_back(name, statistics_of(*region));
    if (std::optional<json::Reader> histogram = reader.object_or_none("histogram")) {
        report.limit = histogram->number("limit", Range::positive());
        report.below = histogram->number("below");
        report.above = histogram->number("above");
        const Eigen::VectorXd counts = histogram->vector("counts");
        report.counts.assign(counts.begin(), counts.end());
    }
    if (!reader.has("verdict")) return report;
    report.within = reader.choice("verdict", {"within", "out of tolerance"}) == "within";
    report.reversed = reader.has("reverse");
    report.judged = reader.choice("judged", {"all", "inside"});
    report.tolerance = reader.number("tolerance", Range::at_least(0));
    report.worst = number_or_nan(reader, "worst");
    if (report.judged == "inside" && (report.regions.size() == 1 || report.regions[1].first != report.judged))
        reader.refuse("judged", "there is no region 'inside'");
    return report;
}

AlignmentReport alignment_of(json::Reader& reader)
{
    AlignmentReport report;
    for (const char* key : {"count", "overlap", "max_distance", "median", "p95", "rms", "determined"})
        report.numbers[key] = number_or_nan(reader, key);
    const Eigen::MatrixXd rows = reader.matrix("transform", 4);
    if (rows.rows() != 4) reader.refuse("transform", "expected 4 rows");
    report.transform = rows;
    return report;
}

FormReport form_of(json::Reader& reader)
{
    FormReport report;
    report.form = reader.text("form");
    report.parameter = reader.text_or("parameter", "");
    for (const char* key : {"count", "dropped", "outliers", "least_squares", "minimum_zone"})
        report.numbers[key] = number_or_nan(reader, key);
    return report;
}

GrindReport grinding_of(json::Reader& reader)
{
    GrindReport report;
    if (!reader.has("finished")) reader.refuse("finished", "missing");
    report.finished = reader.flag_or("finished", false);
    for (const char* key :
         {"removed_volume", "machine_time", "grinding_time", "travel_time", "service_time", "layers", "coverings",
          "re_cuts", "raises", "passes", "steps", "peak_force", "touch_offs", "wheel_changes", "wheel_radius"})
        report.numbers[key] = number_or_nan(reader, key);
    return report;
}

void require(const Cloud& cloud, const std::vector<std::string>& fields, const std::string& source)
{
    try {
        for (const std::string& name : fields) field(cloud, name);
    } catch (const InputError& error) {
        throw InputError(source, error.what());
    }
}

/// Time goes on, and layers are numbers from 1.
void check_trace(const Cloud& trace, const std::string& source)
{
    const Eigen::VectorXd t = field(trace, "t"), layer = field(trace, "layer");
    constexpr double kMostLayers = 1e6; // a plan's are bounded by the safe height
    for (Eigen::Index i = 0; i < t.size(); ++i) {
        const std::string point = "point " + std::to_string(i) + ": ";
        if (!(t[i] >= (i == 0 ? 0 : t[i - 1])) || !std::isfinite(t[i]))
            throw InputError(source, point + "t does not go on: " + to_short_text(t[i]));
        if (!(layer[i] >= 1 && layer[i] <= kMostLayers))
            throw InputError(source, point + "there is no layer " + to_short_text(layer[i]));
    }
}

/// Do two documents say the same, but for what changes of units round?
bool same(const json::Value& a, const json::Value& b)
{
    constexpr Tolerance kRounding = {.absolute = 0, .relative = 1e-9};
    return difference(a.text(), "", b.text(), "", kRounding).equal();
}

/// A plan carries its job and its surface: those that are named should be the same.
std::vector<std::string> doubts(const RunFiles& run, const RunFileNames& names)
{
    std::vector<std::string> found;
    if (!run.plan) return found;
    if (run.job && !same(to_json(*run.job), to_json(run.plan->job)))
        found.push_back(names.plan + ": made for another job than " + names.job);
    if (run.surface && !same(to_json(*run.surface), to_json(run.plan->surface)))
        found.push_back(names.plan + ": made for another surface than " + names.surface);
    return found;
}

} // namespace

const Figures& ComparisonReport::region(const std::string& name) const
{
    return std::find_if(regions.begin(), regions.end(), [&](const auto& of) { return of.first == name; })->second;
}

RunFiles read_run(const RunFileNames& names)
{
    Files files;
    RunFiles run;
    std::optional<Units> units; // once a file has said them
    const auto agree = [&](const Units& stated, const std::string& path) {
        if (units && units->length != stated.length)
            throw InputError(display_name(path),
                             "in " + to_string(stated.length) + ", but the run is in " + to_string(units->length));
        if (!units) units = stated;
    };
    const auto cloud = [&](const std::string& what, const std::string& path, const std::vector<std::string>& fields) {
        const Files::Content content = files.read(what, path);
        CloudFile file = parse_cloud(content.bytes, content.source, units);
        agree(file.units, path);
        require(file.cloud, fields, content.source);
        return std::move(file.cloud);
    };
    const auto part = [&](const std::string& what, const std::string& path,
                          const std::optional<Units::Length>& stated) -> MeshOrCloud {
        const Files::Content content = files.read(what, path);
        return parse_shape(content.bytes, content.source, units_of(stated, units)).shape;
    };
    const auto report = [&](const std::string& what, const std::string& kind, const std::string& path,
                            const auto& content) {
        json::Reader reader = files.json(what, path);
        reader.expect_kind(kind);
        json::Reader stated = reader.object("units");
        agree({parse_length_unit(stated.choice("length", {"mm", "in", "m"})),
               stated.has("force") ? parse_force_unit(stated.choice("force", {"N", "lbf"})) : Units{}.force},
              path);
        return content(reader);
    };
    if (!names.job.empty()) {
        run.job = parse_job(files.json("job", names.job));
        units = run.job->units;
    }
    if (!names.plan.empty()) {
        run.plan = parse_plan(files.json("plan", names.plan));
        agree(run.plan->job.units, names.plan);
    }
    if (!names.surface.empty()) {
        run.surface = parse_surface(files.json("desired surface", names.surface));
        agree(run.surface->units, names.surface);
    }
    run.doubts = doubts(run, names);
    if (run.plan && !run.job) run.job = run.plan->job;
    if (run.plan && !run.surface) run.surface = run.plan->surface;
    if (!names.samples.empty()) run.samples = cloud("touches", names.samples, {});
    if (!names.grinding.empty()) run.grinding = report("grinding", "grinding", names.grinding, grinding_of);
    if (!names.trace.empty()) {
        run.trace = cloud("trace", names.trace, {"t", "layer", "event", "force", "feed"});
        check_trace(*run.trace, display_name(names.trace));
    }
    if (!names.errors.empty()) run.errors = cloud("error map", names.errors, {"error"});
    if (!names.comparison.empty()) run.comparison = report("comparison", "comparison", names.comparison, comparison_of);
    if (!names.alignment.empty()) run.alignment = report("registration", "alignment", names.alignment, alignment_of);
    if (!names.form.empty()) run.form = report("form", "form", names.form, form_of);
    if (!names.before.empty()) run.before = part("part before", names.before, names.before_units);
    if (!names.after.empty()) run.after = part("part after", names.after, std::nullopt);
    run.units = units.value_or(Units{});
    run.sources = std::move(files).known();
    if (run.sources.empty()) throw InputError("nothing to report: name at least one file of the run");
    return run;
}

} // namespace fettle
