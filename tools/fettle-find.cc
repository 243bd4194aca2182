#include "align/rigid.h"
#include "cli/option.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "find/earlier.h"
#include "find/find.h"
#include "find/jobs.h"
#include "find/profile_order.h"
#include "find/registration.h"
#include "job/plausible.h"
#include "job/shape_warnings.h"
#include "mesh/part_output.h"
#include "mesh/read_formats.h"
#include "mesh/shape_file.h"

#include <filesystem>
#include <set>

using namespace fettle;

namespace {

constexpr int kMaxRows = 1000000;

std::vector<int> parse_rows(const std::string& option, const std::string& text)
{
    std::vector<int> rows;
    if (text.empty()) return rows;
    return cli::with_error_prefix(option, [&] {
        for (const std::string& word : cli::split_list(text))
            rows.push_back(static_cast<int>(cli::parse_integer_in(word, 1, kMaxRows)));
        return rows;
    });
}

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("PART", mesh::kReadFormats);
    const std::optional<units::Units::Length>& unit = t.length_unit("--file-units", "Unit of PART, if it states none");
    const std::string& against =
        t.optional_file("--against", "REF",
                        "A mesh or cloud of the part as it should be, or of a good part: departures from it are "
                        "compared instead of the part with itself");
    const std::optional<units::Units::Length>& against_unit = t.length_unit("--against-units", "Unit of REF");
    const std::string& like = t.text(
        "--like", "", "FOLDER",
        "Jobs of an earlier casting of the same kind, as --jobs wrote them: what is found at their places is the same "
        "again, has no doubt, and gets the earlier job. PART is registered to FOLDER/part.pcd, or to the REF of "
        "--against, the part for which the jobs were made");
    const std::string& transform_in = t.optional_file(
        "--transform-in", "FILE", "4 x 4 matrix that puts PART onto REF, as fettle-align writes it: do not register");
    const std::string& transform_out =
        t.optional_output("--transform-out", "Write the 4 x 4 matrix that was applied, 17 digits", {});
    const double& probability = t.number("--probability", find::FindOptions().min_probability, "SHARE",
                                         "Leave out what is less probable", core::Range{0, 1, true, true});
    const std::optional<double>& width = t.optional_number(
        "--max-width", "LENGTH", "Width of the widest anomaly; default: 45 mm", core::Range::positive());
    const std::optional<double>& height = t.optional_number(
        "--min-height", "LENGTH", "Leave out what is lower; default: the tolerance of --template, else 0.2 mm",
        core::Range::at_least(0));
    const std::string& keep = t.text("--keep", "", "ROW,...",
                                     "These rows are anomalies: takes the doubt away that the run without it reports");
    const std::string& drop = t.text("--drop", "", "ROW,...", "These rows belong to the part: leaves them out");
    const std::string& jobs =
        t.text("--jobs", "", "FOLDER",
               "Write a job for each anomaly without a doubt, FOLDER/ROW.json, and FOLDER/part.pcd, "
               "which --like registers to; goes with --template, or --like");
    const std::string& settings =
        t.optional_file("--template", "JOB",
                        "Job with the machine's values for --jobs: probe, tolerance, wheel, forces, feed, removal; "
                        "what stands no higher than its tolerance is left out");
    const std::vector<std::string>& wheels = t.file_list(
        "--wheels",
        "Jobs with other wheels: where the surface is too curved for the template's, the first that fits is "
        "taken, with its forces, feed and removal; if none does, the job says what would");
    const mesh::PartOutput out{t, cloud::cloud_formats()}; // STL has no fields: what was found would be lost
};

/// Jobs to go by: those of an earlier casting, and one with the machine's values for all others.
struct Settings {
    std::vector<find::EarlierJob> earlier;
    std::optional<job::Job> machine;
    std::vector<job::Job> wheels; ///< jobs whose wheels may be taken in place of the machine's

    const job::Job* of(const find::FoundAnomaly& anomaly) const
    {
        const auto same = std::ranges::find(earlier, anomaly.like, &find::EarlierJob::file);
        return same != earlier.end() ? &same->job : machine ? &*machine : nullptr;
    }
};

/// Writes the jobs of all anomalies without a doubt, and the part by which --like will find them. Whether each anomaly
/// has one.
bool write_jobs(const Options& o, find::FindResult& result, const mesh::CloudMesh& part, const Settings& settings)
{
    std::filesystem::create_directories(o.jobs);
    cloud::write_pcd(o.t.output_file(o.jobs + "/part.pcd"), find::registration_points(part), {});
    std::set<std::string> written;
    for (find::FoundAnomaly& anomaly : result.anomalies) {
        if (!anomaly.doubt.empty()) continue;
        const job::Job* const machine = settings.of(anomaly);
        if (machine == nullptr) {
            anomaly.doubt = "no earlier job has it: --template gives the machine's values";
            continue;
        }
        try {
            const find::FoundJob found = find::job_for(anomaly, part, *machine, settings.wheels);
            anomaly.job = o.jobs + "/" + std::to_string(anomaly.number) + ".json";
            anomaly.wheel = found.wheel;
            if (!found.wheel.empty()) o.t.warn(anomaly.job + ": " + found.wheel);
            o.t.output_file(anomaly.job) << job::to_json(found.job);
            written.insert(anomaly.job);
        } catch (const core::InputError& error) {
            anomaly.doubt = error.what();
        }
    }
    for (const auto& entry : std::filesystem::directory_iterator(o.jobs))
        if (const std::string file = o.jobs + "/" + entry.path().filename().string();
            entry.path().extension() == ".json" && !written.contains(file))
            o.t.warn(file + ": not of this run");
    return written.size() == result.anomalies.size();
}

find::FindOptions find_options(const Options& o, const Settings& settings, double mm)
{
    find::FindOptions options;
    options.min_probability = o.probability;
    if (o.width) options.bounds = find::bounds_for_width(*o.width * mm);
    for (const find::EarlierJob& earlier : settings.earlier) options.bounds.min_height = earlier.job.tolerance;
    if (settings.machine) options.bounds.min_height = settings.machine->tolerance;
    if (o.height) options.bounds.min_height = *o.height * mm;
    return options;
}

/// The part registered to a reference, which is read for it.
std::pair<find::Registration, mesh::MeshOrCloud> registered(const Options& o, const std::string& reference_path,
                                                            const mesh::CloudMeshFile& part, const std::string& name)
{
    const std::string reference_name = core::display_name(reference_path);
    mesh::ShapeFile reference = mesh::read_shape(reference_path, mesh::resolve_file_units(o.against_unit));
    if (o.transform_in.empty())
        job::require_no_stray_point(mesh::coordinates_of(reference.shape), reference.units, reference_name);
    for (const std::string& warning : job::shape_warnings(reference, reference_name, reference.units))
        o.t.warn(warning);
    const double mm = part.units.mm();
    std::optional<Eigen::Isometry3d> stated;
    if (!o.transform_in.empty()) {
        stated = Eigen::Isometry3d(align::read_transform(o.transform_in));
        stated->translation() *= mm;
    }
    find::Registration registration =
        cli::with_error_prefix(name, [&] { return find::register_part(part.part, reference.shape, stated); });
    if (!registration.converged) throw core::InputError(name, "cannot be registered to " + reference_name);
    for (const std::string& doubt : registration.doubts) o.t.warn(name + ": " + doubt);
    if (!o.transform_out.empty()) {
        Eigen::Matrix4d matrix = registration.T_reference_part.matrix();
        matrix.topRightCorner<3, 1>() /= mm;
        align::write_transform(o.t.output_file(o.transform_out), matrix);
    }
    return {std::move(registration), std::move(reference.shape)};
}

find::FindResult find_against(const Options& o, const find::FindOptions& options, const mesh::CloudMeshFile& part,
                              const std::string& name)
{
    const std::pair<find::Registration, mesh::MeshOrCloud> against = registered(o, o.against, part, name);
    return cli::with_error_prefix(name, [&] {
        const find::SignedDistances distances =
            find::signed_distances(part.part, against.second, against.first.T_reference_part);
        return find::find_anomalies_against(part.part, distances, options);
    });
}

// What is less probable by itself is no anomaly, whatever stood there on an earlier casting. Whether it is one or a
// feature by design was decided there.
constexpr double kMinLikeProbability = 0.15;

find::FindResult find_like(const Options& o, find::FindOptions options, const std::vector<find::EarlierJob>& jobs,
                           const mesh::CloudMeshFile& part, const std::string& name)
{
    const find::Registration registration =
        registered(o, o.against.empty() ? o.like + "/part.pcd" : o.against, part, name).first;
    options.min_by_evidence = kMinLikeProbability;
    find::FindResult result = cli::with_error_prefix(name, [&] { return find::find_anomalies(part.part, options); });
    find::match_earlier(result, part.part, jobs, registration.T_reference_part, options.min_probability);
    for (const std::string& file : result.absent) o.t.note(file + ": nothing stands there");
    return result;
}

find::FindResult search(const Options& o, const find::FindOptions& options, const Settings& settings,
                        const mesh::CloudMeshFile& part, const std::string& name)
{
    if (!o.like.empty()) return find_like(o, options, settings.earlier, part, name);
    if (!o.against.empty()) return find_against(o, options, part, name);
    return cli::with_error_prefix(name, [&] { return find::find_anomalies(part.part, options); });
}

void check(const Options& o)
{
    if (o.against.empty() && o.like.empty() && (!o.transform_in.empty() || !o.transform_out.empty() || o.against_unit))
        throw core::InputError("--against", "is needed by --transform-in, --transform-out and --against-units");
    if (o.jobs.empty() && !o.wheels.empty()) throw core::InputError("--wheels", "--jobs and --wheels go together");
    if (o.jobs.empty() && !o.settings.empty())
        throw core::InputError("--template", "--jobs and --template go together");
    if (!o.jobs.empty() && o.settings.empty() && o.like.empty())
        throw core::InputError("--jobs", "--jobs and --template go together");
    if (!o.like.empty() && !o.jobs.empty() &&
        std::filesystem::path(o.like).lexically_normal() == std::filesystem::path(o.jobs).lexically_normal())
        throw core::InputError("--jobs", "is the folder of --like: the earlier jobs would be lost");
}

const std::string kDescription =
    "Find the anomalies of a part: excess material that stands over the surface around it.\n"
    "Out: the part with all its fields and triangles, and the fields anomaly (0 none, else the row of the report) and "
    "height over the surface beneath. Without --against the part itself says what belongs to it: smooth metal around a "
    "region is continued beneath it, and the region judged by how far and how plainly it stands over that. Points of a "
    "laser profiler, in its order, are joined to triangles first if its profiles lie far apart. The report "
    "has a row for each anomaly: probability, height, area, volume, significance (height in standard deviations of the "
    "surface beneath), and a doubt where a person should look. Each job has a frame of its own in which its anomaly "
    "faces up. Exit 1 if an anomaly has no job: without --jobs, or for a doubt that --keep or --drop decides.";

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-part parts/hammer.json | fettle-find --report found.json -o labelled.pcd || true",
                  "the weld bead on the hammer: which points it has, and how high it stands over them");
        t.reference("ISO 16610-71 (robust regression filter); Sternberg 1986 (opening by a ball); Rousseeuw 1984; "
                    "Platt 1999 (probabilities)");
        t.parse();
        check(o);
        Settings settings;
        if (!o.like.empty())
            settings.earlier = cli::with_error_prefix("--like", [&] { return find::read_earlier_jobs(o.like); });
        if (!o.settings.empty()) settings.machine = job::read_job(o.settings);
        for (const std::string& file : o.wheels) settings.wheels.push_back(job::read_job(file));
        const std::vector<int> keep = parse_rows("--keep", o.keep), drop = parse_rows("--drop", o.drop);

        mesh::CloudMeshFile file = mesh::read_cloud_mesh(o.path, mesh::resolve_file_units(o.unit));
        const std::string name = core::display_name(o.path);
        if (cli::with_error_prefix(name, [&] { return find::join_profiles(file.part); }))
            t.note(name + ": a profiler's list, searched as triangles between its profiles");
        o.out.format_for(o.out.format == "ply" && file.part.is_mesh());
        const bool registers = o.transform_in.empty() && !(o.against.empty() && o.like.empty());
        if (registers) job::require_no_stray_point(file.part.points.xyz, file.units, name);
        for (const std::string& warning : job::shape_warnings(file, name)) t.warn(warning);

        const units::Units units = o.out.units(cloud::measured_units(file.units, std::nullopt));
        const find::FindOptions options = find_options(o, settings, units.mm());
        find::FindResult result = search(o, options, settings, file, name);
        if (settings.machine) find::add_scatter_doubts(result, *settings.machine);
        find::judge(result, keep, drop);
        const bool all_have_jobs =
            o.jobs.empty() ? result.anomalies.empty() : write_jobs(o, result, file.part, settings);
        find::set_report(t.report(), result, units);
        for (const find::FoundAnomaly& anomaly : result.anomalies)
            if (!anomaly.doubt.empty()) t.note(std::to_string(anomaly.number) + ": " + anomaly.doubt);
        mesh::CloudMesh labelled = find::labelled(std::move(file.part), result);
        if (o.out.format != "ply") labelled.triangles.resize(3, 0); // the others have its vertices
        o.out.write(labelled, file.units);
        return all_have_jobs ? cli::Verdict::yes : cli::Verdict::no;
    });
}
