#include "report/run_files.h"

#include "cloud/pcd.h"
#include "cloud/pcd_header.h"
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

/// Reads the files of a run in the order in which they depend on each other: units and frame come from the first.
class RunReader {
  public:
    explicit RunReader(const RunFileNames& names) : names_(names) {}

    RunFiles read()
    {
        read_design();
        read_grinding_files();
        read_results();
        run_.units = units_.value_or(units::Units{});
        run_.sources = std::move(files_).sources();
        if (run_.sources.empty()) throw core::InputError("nothing to report: name at least one file of the run");
        return std::move(run_);
    }

  private:
    void agree(const units::Units& stated, const std::string& path)
    {
        if (units_ && units_->length != stated.length)
            throw core::InputError(core::display_name(path), "in " + units::to_string(stated.length) +
                                                                 ", but the run is in " +
                                                                 units::to_string(units_->length));
        if (!units_) units_ = stated;
    }

    cloud::Cloud cloud(const std::string& role, const std::string& path, const std::vector<std::string>& fields)
    {
        Files::Content content = files_.read(role, path);
        if (role == kTraceRole) content.bytes = take_whole_rows(content.bytes, content.source, run_.warnings);
        cloud::CloudFile file = cloud::parse_cloud(content.bytes, content.source, units_);
        agree(file.units, path);
        require(file.cloud, fields, content.source);
        if (run_.job) job::move_to_job_frame(file.cloud, *run_.job);
        return std::move(file.cloud);
    }

    mesh::MeshOrCloud part(const std::string& role, const std::string& path,
                           const std::optional<units::Units::Length>& stated)
    {
        const Files::Content content = files_.read(role, path);
        mesh::ShapeFile file =
            mesh::parse_shape(content.bytes, content.source, mesh::resolve_file_units(stated, units_));
        if (const std::string left_out = mesh::repair_warning(file.repair); !left_out.empty())
            run_.warnings.push_back(content.source + ": " + left_out);
        if (run_.job) job::move_to_job_frame(file.shape, *run_.job);
        return std::move(file.shape);
    }

    template <typename Content>
    auto report(const std::string& role, const std::string& kind, const std::string& path, const Content& content)
    {
        json::Reader reader = files_.json(role, path);
        reader.expect_kind(kind);
        json::Reader stated = reader.object("units");
        agree({units::parse_length_unit(stated.choice("length", {"mm", "in", "m"})),
               stated.has("force") ? units::parse_force_unit(stated.choice("force", {"N", "lbf"}))
                                   : units::Units{}.force},
              path);
        return content(reader);
    }

    void read_design()
    {
        if (!names_.job.empty()) {
            run_.job = job::parse_job(files_.json("job", names_.job));
            units_ = run_.job->units;
        }
        if (!names_.plan.empty()) {
            run_.plan = plan::parse_plan(files_.json("plan", names_.plan));
            agree(run_.plan->job.units, names_.plan);
        }
        if (!names_.surface.empty()) {
            run_.surface = surface::parse_surface(files_.json("desired surface", names_.surface));
            agree(run_.surface->units, names_.surface);
        }
        run_.warnings = mismatch_warnings(run_, names_);
        if (run_.plan && !run_.job) run_.job = run_.plan->job;
        if (run_.plan && !run_.surface) run_.surface = run_.plan->surface;
    }

    void read_grinding_files()
    {
        if (!names_.samples.empty()) run_.samples = cloud("touches", names_.samples, {});
        if (!names_.grinding.empty()) run_.grinding = report("grinding", "grinding", names_.grinding, read_grinding);
        if (names_.trace.empty()) return;
        run_.trace = cloud(kTraceRole, names_.trace, {"t", "layer", "event", "force", "feed"});
        drop_unfinished_action(*run_.trace, core::display_name(names_.trace), run_.warnings);
        check_trace(*run_.trace, core::display_name(names_.trace));
    }

    void read_results()
    {
        if (!names_.errors.empty()) run_.errors = cloud("error map", names_.errors, {"error"});
        if (!names_.comparison.empty())
            run_.comparison = report("comparison", "comparison", names_.comparison, read_comparison);
        if (!names_.alignment.empty())
            run_.alignment = report("registration", "alignment", names_.alignment, read_alignment);
        if (!names_.form.empty()) run_.form = report("form", "form", names_.form, read_form);
        if (!names_.nominal.empty()) run_.nominal = report("nominal form", "form", names_.nominal, read_form);
        if (run_.nominal && (!run_.form || run_.form->form != run_.nominal->form))
            throw core::InputError(names_.nominal,
                                   "is of the form " + run_.nominal->form + ", which --form does not measure");
        if (!names_.frames.empty()) run_.frames = read_frames(files_.json("frames", names_.frames), names_.frames);
        if (!names_.before.empty()) run_.before = part("part before", names_.before, names_.before_units);
        if (!names_.after.empty()) run_.after = part("part after", names_.after, std::nullopt);
    }

    const RunFileNames& names_;
    Files files_;
    RunFiles run_;
    std::optional<units::Units> units_; ///< of the first file that states them
};

} // namespace

RunFiles read_run(const RunFileNames& names) { return RunReader(names).read(); }

} // namespace fettle::report
