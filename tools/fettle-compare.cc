#include "cli/option.h"
#include "cli/tool.h"
#include "cloud/cloud_writer.h"
#include "compare/comparison.h"
#include "compare/comparison_report.h"
#include "compare/test_points.h"
#include "core/direction.h"
#include "core/file.h"
#include "job/job.h"
#include "job/plausible.h"
#include "mesh/mesh.h"

#include <algorithm>

namespace {

using namespace fettle;

CloudFormat format_of(const std::string& name, bool ascii)
{
    if (ascii && name != "pcd") throw InputError("--ascii", "goes with --format pcd, not with " + name);
    if (name == "ply") return CloudFormat::ply;
    if (name == "csv") return CloudFormat::csv;
    if (name == "vtk") return CloudFormat::vtk;
    return ascii ? CloudFormat::pcd_ascii : CloudFormat::pcd;
}

void set_fields(ComparisonOptions& options, const std::string& list)
{
    for (const std::string& name : listed(list))
        if (name == "foot")
            options.foot = true;
        else if (name == "facet")
            options.facet = true;
        else if (name == "sigma")
            options.sigma = true;
        else if (name == "region" && options.job)
            options.region = true;
        else
            throw InputError("--fields", name == "region"
                                             ? "region needs --within"
                                             : "expected foot, facet, region or sigma, got '" + name + "'");
}

DistanceOptions distance_options(const std::string& mode, const std::string& direction, const std::string& winding)
{
    if ((mode == "direction") == direction.empty())
        throw InputError("--direction", mode == "direction" ? "--mode direction needs one, x,y,z"
                                                            : "goes with --mode direction, not with --mode " + mode);
    DistanceOptions options;
    if (mode != "normal") options.mode = DistanceMode::direction;
    if (mode == "direction") options.direction = parse_direction(direction, "--direction");
    if (winding != "mend") options.winding = winding == "turn" ? Winding::turn : Winding::keep;
    return options;
}

Reference make_reference(MeshOrCloud shape, const DistanceOptions& options)
{
    if (Mesh* mesh = std::get_if<Mesh>(&shape)) return Reference(std::move(*mesh), options);
    return Reference(std::get<Cloud>(shape), options);
}

/// Adds the verdict to the report.
Verdict give_verdict(Tool& t, const std::vector<Comparison>& comparisons, double tolerance, const Units& units)
{
    Judgement both{true, 0};
    for (const Comparison& comparison : comparisons) {
        const Judgement one = judge(comparison.judged(), tolerance, comparison.largest);
        both = {both.within && one.within, std::max(one.worst, both.worst)};
        if (comparison.judged().count == 0)
            t.warn(std::string(&comparison == &comparisons.front() ? "" : "--reverse: ") +
                   "no point to judge has an error: out of tolerance");
    }
    t.report().set("tolerance", tolerance / units.mm());
    t.report().set("judged", comparisons.front().regions.empty() ? "all" : "inside");
    t.report().set("worst", both.worst / units.mm()).set("verdict", both.within ? "within" : "out of tolerance");
    return both.within ? Verdict::yes : Verdict::no;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Signed error map of a part against its reference: + material left (under-cut), - over-cut.\n"
        "Either is a mesh (STL, PLY, OBJ, OFF) or a cloud (PCD, PLY, XYZ). Out: the points of the test (vertices, if "
        "it is a mesh) with all their fields, the reference's normal, error and rgb. Beyond an open border of the "
        "reference the error is NaN. Exit 1 if an error (with a job: one inside the anomaly's boundary) exceeds the "
        "tolerance. A binary PCD is streamed; other files are held in memory.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& test_path = t.input("TEST", "The part");
        const std::string& reference_path = t.required_file("--to", "FILE", "The reference");
        const auto& reference_unit = t.length_unit("--to-units", "Unit of the reference, if not the job's");
        const auto& test_unit = t.length_unit("--file-units", "Unit of TEST, if not the job's");
        const std::string& job_path = t.other_file("--within", "JOB", "Judge inside its anomaly's boundary; its units");
        const auto& tolerance = t.number_if_given("--tolerance", "LENGTH", "Instead of the job's", Range::at_least(0));
        const std::string& mode = t.choice("--mode", "normal", {"normal", "z", "direction"},
                                           "Distance to the closest point, or along z or a direction");
        const std::string& direction = t.text("--direction", "", "X,Y,Z", "Of --mode direction, out of the material");
        const auto& max_distance =
            t.number_if_given("--max-distance", "LENGTH", "No error beyond it", Range::positive());
        const std::string& winding =
            t.choice("--winding", "mend", {"mend", "keep", "turn"},
                     "Of a mesh: turn facets that disagree with most and closed pieces that are inside out; keep all; "
                     "or turn an open mesh over");
        const std::string& reverse =
            t.other_output("--reverse", "Also the error map of the reference's points against TEST; + is "
                                        "material left, too");
        const std::string& fields = t.text("--fields", "", "LIST",
                                           "More fields, of foot,facet,region,sigma: the nearest point, its facet "
                                           "(from 0), 0 inside 1 around 2 outside, of a cloud as reference");
        const std::string& format = t.choice("--format", "pcd", {"pcd", "ply", "csv", "vtk"}, "Of the error map");
        const bool& ascii = t.flag("--ascii", "Write a PCD as text instead of binary");
        const std::string& csv = t.other_output("--csv", "Statistics, a row for all points and for each region");
        const std::string& histogram = t.other_output("--histogram", "Histogram, CSV: a row for each bin");
        const int& bins = t.count("--bins", 50, "Bins of the histogram", 1, 1000000);
        const int& memory =
            t.count("--max-memory", 1024, "MiB of points and errors to hold; more goes to $TMPDIR", 256, 1 << 24);
        t.example(
            "fettle-part parts/hammer.json | fettle-compare --to scans/hammer.stl --report errors.json -o errors.pcd",
            "what the anomaly adds to the scan: an error map for pcl_viewer or fettle-render, and its statistics");
        t.reference("Wang 2007, 4.3.2 (eq. 4-1) and 6.2; Bærentzen & Aanæs 2005 (sign at edges and vertices)");
        t.parse();

        ComparisonOptions options;
        if (!job_path.empty()) options.job = read_job(job_path);
        set_fields(options, fields);
        const std::optional<Units> job_units = options.job ? std::optional(options.job->units) : std::nullopt;
        options.distance = distance_options(mode, direction, winding);
        options.bins = bins;
        options.memory = static_cast<std::size_t>(memory) << 20;
        const CloudFormat written = format_of(format, ascii);
        std::optional<ShapeFile> whole_test; // a reference itself
        if (!reverse.empty()) whole_test = read_shape(test_path, units_of(test_unit, job_units));
        const TestPoints test = whole_test ? test_points(whole_test->shape, whole_test->units)
                                           : open_test_points(test_path, units_of(test_unit, job_units));
        const Units units = options.job ? options.job->units : test.units;
        if (max_distance) options.distance.max_distance = *max_distance * units.mm();
        if (tolerance || options.job) options.tolerance = tolerance ? *tolerance * units.mm() : options.job->tolerance;
        Survey of_test = survey(test, options);
        ShapeFile shape = read_shape(reference_path, units_of(reference_unit, job_units));
        if (options.job)
            if (const std::string doubt = implausible_box(bounding_box(places_of(shape.shape)), *options.job);
                !doubt.empty())
                t.warn(display_name(reference_path) + ": " + doubt);

        const auto run = [&](const TestPoints& points, Survey& of_points, const Reference& reference,
                             std::ostream& out) {
            CloudWriter writer(out, written, units, points.points.points);
            const auto write = [&](const Cloud& part) { writer.write(part); };
            Comparison result = compare(points, of_points, reference, options, write, t.progress("compare"));
            writer.finish();
            return result;
        };
        std::ostream* back_out = reverse.empty() ? nullptr : &t.output_file(reverse);
        const std::optional<TestPoints> back =
            back_out ? std::optional(test_points(shape.shape, shape.units)) : std::nullopt;
        const bool of_mesh = std::holds_alternative<Mesh>(shape.shape);
        const Reference reference = make_reference(std::move(shape.shape), options.distance);
        std::vector<Comparison> comparisons = {run(test, of_test, reference, t.output())};
        t.report() = to_json(comparisons.front(), units);
        if (of_mesh) t.report().set("reference", to_json(reference.repair(), shape.repair, units));
        if (back) {
            options.reversed = true;
            Survey of_back = survey(*back, options);
            comparisons.push_back(run(*back, of_back, make_reference(whole_test->shape, options.distance), *back_out));
            t.report().set("reverse", to_json(comparisons.back(), units));
        }
        if (!csv.empty()) write_csv(t.output_file(csv), comparisons, units);
        if (!histogram.empty()) write_csv(t.output_file(histogram), comparisons.front().histogram, units);
        if (reference.repair().flipped_facets > 0 && winding == "mend")
            t.warn(display_name(reference_path) + ": " + std::to_string(reference.repair().flipped_facets) +
                   " facets are turned over (--winding)");
        if (!options.tolerance) return Verdict::yes;
        return give_verdict(t, comparisons, *options.tolerance, units);
    });
}
