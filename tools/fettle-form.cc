#include "cli/tool.h"
#include "cloud/cloud.h"
#include "cloud/cloud_output.h"
#include "compare/form_run.h"
#include "core/file.h"
#include "core/text.h"
#include "job/frame.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

#include <algorithm>
#include <numbers>

using namespace fettle;

namespace {

const std::vector<std::string> kKinds = {"flatness", "cylindricity", "sphericity", "straightness"}; // as FormKind
constexpr double kMaxOverlap = 100; // sections that a point may belong to: bounds time and memory

void check_sections(const std::string& kind, const std::optional<double>& spacing, const std::optional<double>& width)
{
    if (spacing && kind != "straightness")
        throw core::InputError("--sections", "goes with straightness, not with " + kind);
    if (width && !spacing) throw core::InputError("--section-width", "goes with --sections");
    if (width && *width > kMaxOverlap * *spacing)
        throw core::InputError("--section-width",
                               "must be at most " + core::to_text(kMaxOverlap) + " times --sections");
}

const std::string kDescription =
    "Measure the form error of points: the width of the zone that holds them all, about the element of least squares "
    "and at its narrowest (minimum zone). Out: JSON, with both elements, and the points that touch the minimum "
    "zone.\n"
    "No filter is applied, and every point counts: noise widens the zone by some five of its standard deviations "
    "among a hundred points and ten among a million, an outlier by all that it is off. --outliers leaves out what "
    "is no part of the surface.";

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const std::string& kind = t.positional_choice("FORM", kKinds, "What is measured");
        const std::string& path =
            t.main_input("POINTS", "A cloud (PCD, PLY, XYZ), or a mesh (STL, PLY, OBJ, OFF): its vertices");
        const auto& unit = t.length_unit("--file-units", "Unit of POINTS, if not the job's");
        const std::string& job_path =
            t.optional_file("--within", "JOB", "Only points inside its anomaly's boundary; its units");
        const auto& outliers =
            t.optional_number("--outliers", "SIGMAS",
                              "Leave out points farther from the least squares element than so many robust "
                              "standard deviations; they are counted",
                              core::Range::positive());
        const auto& spacing =
            t.optional_number("--sections", "LENGTH",
                              "Straightness of vertical sections at this spacing; without it, of all points as "
                              "one line",
                              core::Range::positive());
        const auto& width = t.optional_number(
            "--section-width", "LENGTH", "Points within half of it belong to a section; as --sections, if not given",
            core::Range::positive());
        const double& direction =
            t.number("--direction", 0, "DEG", "Direction of the sections, counter-clockwise from X",
                     core::Range::between(-360, 360));
        const auto& out_unit =
            t.length_unit("--units", "Unit of the lengths reported; default: that of POINTS, mm for metres");
        t.example("fettle-form flatness scans/panel.pcd",
                  "how flat a scanned panel is, in the unit that the file states");
        t.reference("ISO 12781 (flatness), 12180 (cylindricity), 12780 (straightness), 1101; Wang 2007, 6.2");
        t.output_formats({"json"});
        t.parse();
        check_sections(kind, spacing, width);

        compare::FormRequest request;
        request.kind = static_cast<compare::FormKind>(std::ranges::find(kKinds, kind) - kKinds.begin());
        request.outlier_limit = outliers;
        if (!job_path.empty()) request.job = job::read_job(job_path);
        const std::optional<units::Units> job_units = request.job ? std::optional(request.job->units) : std::nullopt;
        mesh::ShapeFile file = mesh::read_shape(path, mesh::resolve_file_units(unit, job_units));
        if (request.job) job::move_to_job_frame(file.shape, *request.job);
        units::Units units = cloud::measured_units(file.units, job_units);
        if (out_unit && !job_units) units.length = *out_unit;
        const units::Units written{out_unit.value_or(units.length), units.force};
        cloud::Cloud points;
        points.xyz = mesh::coordinates_of(file.shape);
        if (spacing)
            request.sections = {*spacing * units.mm(), width.value_or(*spacing) * units.mm(),
                                direction * std::numbers::pi / 180};
        const compare::FormRun run = cli::with_error_prefix(
            core::display_name(path) + ": " + kind, [&] { return compare::measure_form(points, request, written); });
        for (const std::string& warning : job::shape_warnings(file, core::display_name(path), units)) t.warn(warning);
        if (run.dropped > 0)
            t.warn(core::display_name(path) + ": " + std::to_string(run.dropped) + " points without x y z dropped");
        t.report() = run.report;
        t.output() << run.report;
        return cli::Verdict::yes;
    });
}
