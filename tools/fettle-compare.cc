#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/areas.h"
#include "compare/colours.h"
#include "compare/shape_file.h"
#include "compare/signed_distance.h"
#include "compare/statistics.h"
#include "core/file.h"
#include "core/text.h"
#include "job/job.h"
#include "job/plausible.h"
#include "mesh/mesh.h"

#include <cmath>
#include <sstream>

namespace {

using namespace fettle;

std::optional<Units> units_of(const std::optional<Units::Length>& stated, const std::optional<Job>& job)
{
    if (stated) return Units{*stated, job ? job->units.force : Units::Force::N};
    return job ? std::optional(job->units) : std::nullopt;
}

DistanceOptions distance_options(const std::string& mode, const std::string& direction)
{
    DistanceOptions options;
    if (mode != "normal") options.mode = DistanceMode::direction;
    if ((mode == "direction") == direction.empty())
        throw InputError("--direction", mode == "direction" ? "--mode direction needs one, x,y,z"
                                                            : "goes with --mode direction, not with --mode " + mode);
    if (mode != "direction") return options;
    std::istringstream parts(direction + ",");
    std::string part;
    int read = 0;
    for (; std::getline(parts, part, ','); ++read) {
        const std::optional<double> number = parse_number(part);
        if (read >= 3 || !number || !std::isfinite(*number))
            throw InputError("--direction", "expected three numbers x,y,z, got '" + direction + "'");
        options.direction[read] = *number;
    }
    if (read != 3) throw InputError("--direction", "expected three numbers x,y,z, got '" + direction + "'");
    if (!(options.direction.norm() > 0)) throw InputError("--direction", "has no length: '" + direction + "'");
    options.direction.normalize();
    return options;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Signed error map of a part against its reference: + material left (under-cut), - over-cut.\n"
        "Either is a mesh (STL, PLY, OBJ, OFF) or a cloud (PCD, PLY, XYZ). Out: the points of the test (vertices, if "
        "it "
        "is a mesh) with all their fields, the reference's normal, error and rgb. Beyond an open border of the "
        "reference "
        "the error is NaN. Exit 1 if an error (with a job: one inside the anomaly's boundary) exceeds the tolerance.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& test_path = t.input("TEST", "The part");
        const std::string& reference_path = t.required_text("--to", "FILE", "The reference");
        const auto& reference_unit = t.length_unit("--to-units", "Unit of the reference, if not the job's");
        const auto& test_unit = t.length_unit("--file-units", "Unit of TEST, if not the job's");
        const std::string& job_path = t.text("--within", "", "JOB", "Judge inside its anomaly's boundary; its units");
        const auto& tolerance_given =
            t.number_if_given("--tolerance", "LENGTH", "Instead of the job's", Range::at_least(0));
        const std::string& mode = t.choice("--mode", "normal", {"normal", "z", "direction"},
                                           "Distance to the closest point, or along z or a direction");
        const std::string& direction = t.text("--direction", "", "X,Y,Z", "Of --mode direction, out of the material");
        const auto& max_distance =
            t.number_if_given("--max-distance", "LENGTH", "No error beyond it", Range::positive());
        const bool& ascii = t.flag("--ascii", "Write text instead of binary");
        t.example(
            "fettle-part parts/hammer.json | fettle-compare --to scans/hammer.stl --report errors.json -o errors.pcd",
            "what the anomaly adds to the scan: an error map for pcl_viewer or fettle-render, and its statistics");
        t.reference("Wang 2007, 4.3.2 (eq. 4-1) and 6.2; Bærentzen & Aanæs 2005 (sign at edges and vertices)");
        t.parse();

        const std::optional<Job> job = job_path.empty() ? std::nullopt : std::optional(read_job(job_path));
        DistanceOptions options = distance_options(mode, direction);
        const ShapeFile test = read_shape(test_path, units_of(test_unit, job));
        const Units units = job ? job->units : test.units;
        const ShapeFile reference = read_shape(reference_path, units_of(reference_unit, job));
        if (max_distance) options.max_distance = *max_distance * units.mm();
        std::optional<double> tolerance;
        if (tolerance_given)
            tolerance = *tolerance_given * units.mm();
        else if (job)
            tolerance = job->tolerance;

        Cloud map_cloud = points_of(test.shape);
        const ErrorMap map = std::visit(
            [&](const auto& shape) { return signed_distance(map_cloud.xyz, shape, options); }, reference.shape);
        const Mesh* mesh = std::get_if<Mesh>(&test.shape);
        const Eigen::VectorXd areas = mesh ? volume_areas(*mesh, options) : volume_areas(map_cloud.xyz, map, options);

        if (job)
            if (const std::string doubt = implausible_box(bounding_box(points_of(reference.shape).xyz), *job);
                !doubt.empty())
                t.warn(display_name(reference_path) + ": " + doubt);

        json::Value& report = t.report();
        const Statistics all = statistics(map.error, areas, tolerance);
        report = to_json(all, units);
        Statistics judged = all;
        if (job) {
            const std::vector<Region> region = regions(*job, map_cloud.xyz);
            judged = statistics(map.error, areas, tolerance, region, Region::inside);
            json::Value by_region;
            by_region.set("inside", to_json(judged, units));
            by_region.set("around", to_json(statistics(map.error, areas, tolerance, region, Region::around), units));
            by_region.set("outside", to_json(statistics(map.error, areas, tolerance, region, Region::outside), units));
            report.set("regions", by_region);
        }
        if (map.reference_sigma.size() > 0) report.set("reference_sigma", median(map.reference_sigma) / units.mm());

        set_normals(map_cloud, map.normal);
        set_field(map_cloud, "error", map.error);
        set_colours(map_cloud, colours(colour_scale(map.error, tolerance.value_or(0)), map.error));
        write_pcd(t.output(), map_cloud, units, ascii ? PcdEncoding::ascii : PcdEncoding::binary);

        if (!tolerance) return Verdict::yes;
        const Judgement judgement = judge(judged, *tolerance, map_cloud.xyz);
        report.set("tolerance", *tolerance / units.mm()).set("judged", job ? "inside" : "all");
        report.set("worst", judgement.worst / units.mm())
            .set("verdict", judgement.within ? "within" : "out of tolerance");
        if (judged.count == 0) t.warn("no point to judge has an error: out of tolerance");
        return judgement.within ? Verdict::yes : Verdict::no;
    });
}
