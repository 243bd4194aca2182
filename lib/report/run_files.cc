#include "report/run_files.h"

#include "cloud/pcd.h"
#include "cloud/pcd_header.h"
#include "core/constants.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "diff/diff.h"
#include "job/frame.h"
#include "strategy/trace_file.h"
#include "json/document.h"

#include <algorithm>
#include <cmath>

namespace fettle::report {
namespace {

const std::string kTraceRole = "trace";

/// Reads each file once, for its content, size and checksum.
class Files {
  public:
    struct Content {
        std::string bytes, source;
    };
    Content read(const std::string& role, const std::string& path, std::size_t max_bytes = std::string::npos)
    {
        Content content = {core::read_file(path, max_bytes), core::display_name(path)};
        sources_.push_back({role, content.source, content.bytes.size(), core::sha256(content.bytes)});
        return content;
    }
    json::Reader json(const std::string& role, const std::string& path)
    {
        const Content content = read(role, path, core::kMaxJsonBytes);
        return json::Reader::parse(content.bytes, content.source);
    }
    std::vector<SourceFile> sources() && { return std::move(sources_); }

  private:
    std::vector<SourceFile> sources_;
};

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

Eigen::Matrix4d read_matrix(json::Reader& reader)
{
    const Eigen::MatrixXd rows = reader.matrix("transform", 4);
    if (rows.rows() != 4) reader.refuse("transform", "expected 4 rows");
    return rows;
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
    return report;
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

void require(const cloud::Cloud& cloud, const std::vector<std::string>& fields, const std::string& source)
{
    try {
        for (const std::string& name : fields) cloud::field(cloud, name);
    } catch (const core::InputError& error) {
        throw core::InputError(source, error.what());
    }
}

/// Checks that time does not decrease and that layers are numbered from 1.
void check_trace(const cloud::Cloud& trace, const std::string& source)
{
    const Eigen::VectorXd t = cloud::field(trace, "t"), layer = cloud::field(trace, "layer");
    constexpr double kMaxLayers = 1e6; // far above those of a plan, which the safe height bounds
    for (Eigen::Index i = 0; i < t.size(); ++i) {
        const std::string point = "point " + std::to_string(i) + ": ";
        if (!(t[i] >= (i == 0 ? 0 : t[i - 1])) || !std::isfinite(t[i]))
            throw core::InputError(source, point + "t decreases or is not finite: " + core::to_short_text(t[i]));
        if (!(layer[i] >= 1 && layer[i] <= kMaxLayers))
            throw core::InputError(source, point + "there is no layer " + core::to_short_text(layer[i]));
    }
}

/// Are two documents equal up to the rounding of unit conversions?
bool equal(const json::Value& a, const json::Value& b)
{
    constexpr diff::Tolerance kTolerance = {.absolute = 0, .relative = 1e-9};
    return diff::compare_contents(a.text(), "", b.text(), "", kTolerance).equal();
}

/// A plan contains its job and its surface. Warns if the given files differ from them.
std::vector<std::string> mismatch_warnings(const RunFiles& run, const RunFileNames& names)
{
    std::vector<std::string> warnings;
    if (!run.plan) return warnings;
    if (run.job && !equal(job::to_json(*run.job), job::to_json(run.plan->job)))
        warnings.push_back(names.plan + ": made for another job than " + names.job);
    if (run.surface && !equal(surface::to_json(*run.surface), surface::to_json(run.plan->surface)))
        warnings.push_back(names.plan + ": made for another surface than " + names.surface);
    return warnings;
}

/// What a run has completed of its trace. Warns if that is not all of it: the run was killed, or the file was cut.
std::string take_whole_rows(const std::string& bytes, const std::string& source, std::vector<std::string>& warnings)
{
    if (!cloud::looks_like_pcd(bytes)) return bytes;
    strategy::WholeRows whole = strategy::whole_rows(bytes, source);
    if (!whole.cut.empty()) warnings.push_back(source + ": " + whole.cut);
    return std::move(whole.pcd);
}

/// The last point of a run that was killed says where the machine was to go, not what it did.
void drop_unfinished_action(cloud::Cloud& trace, const std::string& source, std::vector<std::string>& warnings)
{
    const Eigen::VectorXd event = cloud::field(trace, "event");
    if (event.size() == 0 || event[event.size() - 1] != double(strategy::Event::in_progress)) return;
    trace = cloud::slice(trace, 0, trace.size() - 1);
    warnings.push_back(source + ": the run was killed in the middle of a move, which is left out");
}

} // namespace

const NamedNumbers& ComparisonReport::region(const std::string& name) const
{
    return std::ranges::find(regions, name, &std::pair<std::string, NamedNumbers>::first)->second;
}

RunFiles read_run(const RunFileNames& names)
{
    Files files;
    RunFiles run;
    std::optional<units::Units> units; // those of the first file that states them
    const auto agree = [&](const units::Units& stated, const std::string& path) {
        if (units && units->length != stated.length)
            throw core::InputError(core::display_name(path), "in " + units::to_string(stated.length) +
                                                                 ", but the run is in " +
                                                                 units::to_string(units->length));
        if (!units) units = stated;
    };
    const auto cloud = [&](const std::string& role, const std::string& path, const std::vector<std::string>& fields) {
        Files::Content content = files.read(role, path);
        if (role == kTraceRole) content.bytes = take_whole_rows(content.bytes, content.source, run.warnings);
        cloud::CloudFile file = cloud::parse_cloud(content.bytes, content.source, units);
        agree(file.units, path);
        require(file.cloud, fields, content.source);
        if (run.job) job::move_to_job_frame(file.cloud, *run.job);
        return std::move(file.cloud);
    };
    const auto part = [&](const std::string& role, const std::string& path,
                          const std::optional<units::Units::Length>& stated) -> mesh::MeshOrCloud {
        const Files::Content content = files.read(role, path);
        mesh::MeshOrCloud shape =
            mesh::parse_shape(content.bytes, content.source, mesh::resolve_file_units(stated, units)).shape;
        if (run.job) job::move_to_job_frame(shape, *run.job);
        return shape;
    };
    const auto report = [&](const std::string& role, const std::string& kind, const std::string& path,
                            const auto& content) {
        json::Reader reader = files.json(role, path);
        reader.expect_kind(kind);
        json::Reader stated = reader.object("units");
        agree({units::parse_length_unit(stated.choice("length", {"mm", "in", "m"})),
               stated.has("force") ? units::parse_force_unit(stated.choice("force", {"N", "lbf"}))
                                   : units::Units{}.force},
              path);
        return content(reader);
    };
    if (!names.job.empty()) {
        run.job = job::parse_job(files.json("job", names.job));
        units = run.job->units;
    }
    if (!names.plan.empty()) {
        run.plan = plan::parse_plan(files.json("plan", names.plan));
        agree(run.plan->job.units, names.plan);
    }
    if (!names.surface.empty()) {
        run.surface = surface::parse_surface(files.json("desired surface", names.surface));
        agree(run.surface->units, names.surface);
    }
    run.warnings = mismatch_warnings(run, names);
    if (run.plan && !run.job) run.job = run.plan->job;
    if (run.plan && !run.surface) run.surface = run.plan->surface;
    if (!names.samples.empty()) run.samples = cloud("touches", names.samples, {});
    if (!names.grinding.empty()) run.grinding = report("grinding", "grinding", names.grinding, read_grinding);
    if (!names.trace.empty()) {
        run.trace = cloud(kTraceRole, names.trace, {"t", "layer", "event", "force", "feed"});
        drop_unfinished_action(*run.trace, core::display_name(names.trace), run.warnings);
        check_trace(*run.trace, core::display_name(names.trace));
    }
    if (!names.errors.empty()) run.errors = cloud("error map", names.errors, {"error"});
    if (!names.comparison.empty())
        run.comparison = report("comparison", "comparison", names.comparison, read_comparison);
    if (!names.alignment.empty()) run.alignment = report("registration", "alignment", names.alignment, read_alignment);
    if (!names.form.empty()) run.form = report("form", "form", names.form, read_form);
    if (!names.before.empty()) run.before = part("part before", names.before, names.before_units);
    if (!names.after.empty()) run.after = part("part after", names.after, std::nullopt);
    run.units = units.value_or(units::Units{});
    run.sources = std::move(files).sources();
    if (run.sources.empty()) throw core::InputError("nothing to report: name at least one file of the run");
    return run;
}

} // namespace fettle::report
