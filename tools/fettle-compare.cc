#include "cli/option.h"
#include "cli/output_format.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "compare/comparison_report.h"
#include "compare/comparison_run.h"
#include "core/direction.h"

using namespace fettle;

namespace {

void set_fields(compare::ComparisonOptions& options, const std::string& list)
{
    for (const std::string& name : cli::split_list(list))
        if (name == "foot")
            options.with_foot = true;
        else if (name == "facet")
            options.with_facet = true;
        else if (name == "sigma")
            options.with_sigma = true;
        else if (name == "region" && options.job)
            options.with_region = true;
        else
            throw core::InputError("--fields", name == "region"
                                                   ? "region needs --within"
                                                   : "expected foot, facet, region or sigma, got '" + name + "'");
}

compare::DistanceOptions distance_options(const std::string& mode, const std::string& direction,
                                          compare::Winding winding)
{
    if ((mode == "direction") == direction.empty())
        throw core::InputError("--direction", mode == "direction"
                                                  ? "--mode direction needs one, x,y,z"
                                                  : "goes with --mode direction, not with --mode " + mode);
    compare::DistanceOptions options;
    options.winding = winding;
    if (mode != "normal") options.mode = compare::DistanceMode::direction;
    if (mode == "direction") options.direction = core::parse_direction(direction, "--direction");
    return options;
}

/// The request, and the names of the other outputs.
struct Options {
    compare::ComparisonRequest request;
    std::string reverse, csv, histogram;
};

Options parse_options(cli::Tool& t)
{
    const std::string& test_path = t.main_input("TEST", "The part");
    const std::string& reference_path = t.required_file_option("--to", "FILE", "The reference");
    const auto& reference_unit = t.length_unit("--to-units", "Unit of the reference, if not the job's");
    const auto& test_unit = t.length_unit("--file-units", "Unit of TEST, if not the job's");
    const std::string& job_path = t.optional_file("--within", "JOB", "Judge inside its anomaly's boundary; its units");
    const auto& tolerance = t.optional_number("--tolerance", "LENGTH", "Tolerance that takes the place of the job's",
                                              core::Range::at_least(0));
    const std::string& mode = t.choice("--mode", "normal", {"normal", "z", "direction"},
                                       "Distance to the closest point, or along z or a direction");
    const std::string& direction =
        t.text("--direction", "", "X,Y,Z", "Direction for --mode direction, out of the material");
    const auto& max_distance =
        t.optional_number("--max-distance", "LENGTH", "No error beyond it", core::Range::positive());
    const auto& winding = t.choice<compare::Winding>(
        "--winding",
        {{"mend", compare::Winding::repair}, {"keep", compare::Winding::keep}, {"turn", compare::Winding::flip}},
        "Facets of a mesh: flip those that disagree with the majority, and closed pieces that are inside out; keep "
        "all; "
        "or flip an open mesh");
    const std::string& reverse = t.optional_output("--reverse",
                                                   "Also the error map of the reference's points against TEST; + is "
                                                   "material left, too",
                                                   cloud::cloud_formats());
    const std::string& fields = t.text("--fields", "", "LIST",
                                       "More fields, of foot,facet,region,sigma: the nearest point, its facet "
                                       "(from 0), 0 inside 1 around 2 outside, of a cloud as reference");
    const cloud::CloudOutput out{t};
    const std::string& csv =
        t.optional_output("--csv", "Statistics, a row for all points and for each region", {"csv"});
    const std::string& histogram = t.optional_output("--histogram", "Histogram, CSV: a row for each bin", {"csv"});
    const int& bins = t.count("--bins", 50, "Bins of the histogram", 1, 1000000);
    const int& memory =
        t.count("--max-memory", 1024, "MiB of points and errors to hold; more goes to $TMPDIR", 256, 1 << 24);
    t.example("fettle-part parts/hammer.json | fettle-compare --to scans/hammer.stl --report errors.json -o errors.pcd",
              "what the anomaly adds to the scan: an error map for pcl_viewer or fettle-render, and its statistics");
    t.reference("Wang 2007, 4.3.2 (eq. 4-1) and 6.2; Bærentzen & Aanæs 2005 (sign at edges and vertices)");
    t.parse();

    compare::ComparisonRequest request;
    request.test = test_path;
    request.reference = reference_path;
    request.test_unit = test_unit;
    request.reference_unit = reference_unit;
    request.tolerance = tolerance;
    request.max_distance = max_distance;
    if (!job_path.empty()) request.options.job = job::read_job(job_path);
    set_fields(request.options, fields);
    request.options.distance = distance_options(mode, direction, winding);
    request.options.bins = bins;
    request.options.max_memory = static_cast<std::size_t>(memory) << 20;
    if (out.ascii && out.format != "pcd") throw core::InputError("--ascii", "goes with PCD, not with " + out.format);
    request.format = cloud::cloud_format(out.format, out.ascii);
    request.reverse_format = cloud::cloud_format(cli::format_of_output(reverse, cloud::cloud_formats()), out.ascii);
    request.output_unit = out.unit;
    return {request, reverse, csv, histogram};
}

const std::string kDescription =
    "Compare a part with its reference, as a signed error map: + material left (under-cut), - over-cut.\n"
    "Either is a mesh (STL, PLY, OBJ, OFF) or a cloud (PCD, PLY, XYZ). Out: the points of the test (vertices, if "
    "it is a mesh) with all their fields, the reference's normal, error and rgb. Beyond an open border of the "
    "reference the error is NaN. Exit 1 if an error (with a job: one inside the anomaly's boundary) exceeds the "
    "tolerance, or if no point has an error. A binary PCD is streamed; other files are held in memory.";

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options options = parse_options(t);
        std::ostream* reverse = options.reverse.empty() ? nullptr : &t.output_file(options.reverse);
        const compare::ComparisonRun run =
            compare::compare_files(options.request, t.output(), reverse, [&] { return t.progress("compare"); });

        t.report() = run.report;
        for (const std::string& warning : run.warnings) t.warn(warning);
        if (!options.csv.empty()) compare::write_csv(t.output_file(options.csv), run.comparisons, run.units);
        if (!options.histogram.empty())
            compare::write_csv(t.output_file(options.histogram), run.comparisons.front().histogram, run.units);
        return run.conforms ? cli::Verdict::yes : cli::Verdict::no;
    });
}
