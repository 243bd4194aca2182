#include "compare/comparison_run.h"

#include "cloud/cloud_output.h"
#include "compare/comparison_report.h"
#include "compare/judgement.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "job/frame.h"
#include "job/plausible.h"
#include "mesh/shape_file.h"

#include <algorithm>

namespace fettle::compare {

namespace {

Reference make_reference(mesh::MeshOrCloud shape, const DistanceOptions& options)
{
    if (mesh::Mesh* mesh = std::get_if<mesh::Mesh>(&shape)) return {std::move(*mesh), options};
    return {std::get<cloud::Cloud>(shape), options};
}

ComparisonOptions options_in_mm(const ComparisonRequest& request, const units::Units& units)
{
    ComparisonOptions options = request.options;
    if (options.job) options.tolerance = options.job->tolerance;
    if (request.tolerance) options.tolerance = *request.tolerance * units.mm();
    if (request.max_distance) options.distance.max_distance = *request.max_distance * units.mm();
    return options;
}

/// Adds a warning about a file, unless it is empty.
void warn(ComparisonRun& run, const std::string& name, const std::string& warning)
{
    if (!warning.empty()) run.warnings.push_back(name + ": " + warning);
}

/// Warns of what reading the reference left out, and of a size that is hardly meant, for the job if there is one.
void check_reference(ComparisonRun& run, const std::string& name, const mesh::ShapeFile& file,
                     const std::optional<job::Job>& job)
{
    const Eigen::Matrix3Xd& points = mesh::coordinates_of(file.shape);
    const Eigen::AlignedBox3d box = geometry::finite_bounding_box(points);
    warn(run, name, mesh::repair_warning(file.repair));
    std::string doubt = job::stray_point_warning(points, run.units);
    if (doubt.empty())
        doubt = job ? job::part_box_warning(box, *job) : job::size_warning(box, points.cols(), run.units);
    warn(run, name, doubt);
}

/// @throws InputError if one of two files is in the frame of a job and the other is not
void require_same_frame(cloud::Frame test, cloud::Frame reference, const std::string& test_name,
                        const std::string& reference_name)
{
    if (test == reference) return;
    const bool is_test = test == cloud::Frame::job;
    throw core::InputError(is_test ? test_name : reference_name,
                           "is in the frame of its job, " + (is_test ? reference_name : test_name) +
                               " in the part's: --within JOB says where that frame is");
}

void warn_of_repair(ComparisonRun& run, const std::string& name, const ReferenceRepair& repair, Winding winding)
{
    if (repair.opposite_facets > 0)
        warn(run, name,
             std::to_string(repair.opposite_facets) +
                 " facets repeat another wound the other way and are left out: the first defines the outer side");
    if (repair.flipped_facets > 0 && winding == Winding::repair)
        warn(run, name, std::to_string(repair.flipped_facets) + " facets are turned over (--winding)");
}

/// Without a tolerance there is no verdict, but a comparison in which no point has an error has compared nothing.
void require_errors(ComparisonRun& run)
{
    run.conforms = run.comparisons.front().all.count > 0;
    for (const Comparison& comparison : run.comparisons) {
        if (comparison.all.count > 0) continue;
        run.warnings.push_back(std::string(&comparison == &run.comparisons.front() ? "" : "--reverse: ") +
                               "no point has an error: nothing was compared");
    }
}

/// Adds the verdict about all comparisons to the report.
void judge(ComparisonRun& run, double tolerance)
{
    Conformity both{true, 0};
    for (const Comparison& comparison : run.comparisons) {
        const geometry::Statistics& statistics = comparison.verdict_statistics();
        const Conformity one = judge_conformity(statistics, tolerance, comparison.max_coordinate());
        both = {both.within && one.within, std::max(one.max_abs_error, both.max_abs_error)};
        if (statistics.count == 0)
            run.warnings.push_back(std::string(&comparison == &run.comparisons.front() ? "" : "--reverse: ") +
                                   "no point to judge has an error: out of tolerance");
    }
    run.conforms = both.within;
    run.report.set("tolerance", tolerance / run.units.mm())
        .set("judged", run.comparisons.front().regions.empty() ? "all" : "inside")
        .set("worst", both.max_abs_error / run.units.mm())
        .set("verdict", both.within ? "within" : "out of tolerance");
}

} // namespace

ComparisonRun compare_files(const ComparisonRequest& request, std::ostream& out, std::ostream* reverse_out,
                            const std::function<core::Progress()>& progress)
{
    const std::optional<job::Job>& job = request.options.job;
    const auto units_of = [&](const std::optional<units::Units::Length>& stated) {
        return mesh::resolve_file_units(stated, job ? std::optional(job->units) : std::nullopt);
    };
    std::optional<mesh::ShapeFile> whole_test; // the reference of the reverse comparison
    if (reverse_out) whole_test = mesh::read_shape(request.test, units_of(request.test_unit));
    if (whole_test && job) job::move_to_job_frame(whole_test->shape, *job);
    const TestPoints test = whole_test ? test_points(whole_test->shape, whole_test->units)
                                       : open_test_points(request.test, units_of(request.test_unit), job);
    ComparisonRun run;
    run.units = cloud::measured_units(test.units, job ? std::optional(job->units) : std::nullopt);
    if (request.output_unit && !job) run.units.length = *request.output_unit;
    ComparisonOptions options = options_in_mm(request, run.units);
    if (request.output_unit) run.units.length = *request.output_unit;

    Survey survey = start_survey(test, options); // while the reference is read
    mesh::ShapeFile file = mesh::read_shape(request.reference, units_of(request.reference_unit));
    const std::string reference_name = core::display_name(request.reference);
    if (job) job::move_to_job_frame(file.shape, *job);
    require_same_frame(test.frame, mesh::frame_of(file.shape), core::display_name(request.test), reference_name);
    check_reference(run, reference_name, file, job);
    std::optional<TestPoints> reverse_test;
    if (reverse_out) reverse_test = test_points(file.shape, file.units);
    const bool is_mesh = std::holds_alternative<mesh::Mesh>(file.shape);
    const Reference reference = make_reference(std::move(file.shape), options.distance);

    const auto compare_points = [&](const TestPoints& points, Survey& of_points, const Reference& to, std::ostream& map,
                                    cloud::CloudFormat format) -> const Comparison& {
        cloud::CloudWriter writer(map, format, run.units, points.points.points);
        const auto write = [&](const cloud::Cloud& part) { writer.write(part); };
        run.comparisons.push_back(compare(points, of_points, to, options, write, progress()));
        writer.finish();
        return run.comparisons.back();
    };
    run.report = to_json(compare_points(test, survey, reference, out, request.format), run.units);
    const ReferenceRepair& repair = reference.repair();
    if (is_mesh) run.report.set("reference", to_json(repair, file.repair, run.units));
    if (reverse_out) {
        options.reversed = true;
        Survey reverse_survey = start_survey(*reverse_test, options);
        const Reference test_reference = make_reference(std::move(whole_test->shape), options.distance);
        run.report.set("reverse", to_json(compare_points(*reverse_test, reverse_survey, test_reference, *reverse_out,
                                                         request.reverse_format),
                                          run.units));
        warn_of_repair(run, core::display_name(request.test), test_reference.repair(), options.distance.winding);
    }
    const Comparison& first = run.comparisons.front();
    const std::string test_name = core::display_name(request.test);
    warn(run, test_name, mesh::repair_warning(whole_test ? whole_test->repair : test.repair));
    warn(run, test_name, job::size_warning(first.box, first.all.count + first.all.undefined, run.units));
    warn_of_repair(run, reference_name, repair, options.distance.winding);
    if (options.tolerance)
        judge(run, *options.tolerance);
    else
        require_errors(run);
    return run;
}

} // namespace fettle::compare
