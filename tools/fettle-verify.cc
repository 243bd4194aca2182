#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "job/plausible.h"
#include "machining/correction.h"
#include "machining/limits.h"
#include "machining/part_mesh.h"
#include "machining/patch_report.h"
#include "machining/path_options.h"
#include "machining/tilt.h"
#include "machining/workpiece.h"

#include <optional>
#include <ostream>

using namespace fettle;

namespace {

const std::string kDescription =
    "Verify a machined surface against its design by triangle patches.\n"
    "The design is re-sampled at the x, y of the machined vertices; of each pair of triangles d is the mean of the "
    "three differences along Z (the tool axis), and the error is d along the normal of the design's triangle: + "
    "material left. Where "
    "the design is vertical or not hit, or the machined triangle does not face up, it is undefined: counted and "
    "listed. Out: a point for each patch, coloured bright red, dark red (over-cut), grey, violet, dark blue (material "
    "left). With --correct also a path that is corrected by the errors. Lengths in mm. Exit 1 if a patch is over-cut "
    "beyond the tolerance, or none is defined.";

struct Options {
    cli::Tool& t;
    const std::string& machined =
        t.main_input("MACHINED", "Triangles that face up (fettle-mill): STL, PLY, OBJ or OFF");
    const std::optional<units::Units::Length>& unit =
        t.length_unit("--file-units", "Unit of MACHINED, if it is not mm");
    const std::string& design = t.required_file_option("--design", "FILE", "The design: STL, PLY, OBJ or OFF");
    const std::optional<units::Units::Length>& design_unit =
        t.length_unit("--design-units", "Unit of the design, if it is not mm");
    const double& tolerance =
        t.number("-t,--tolerance", 0.05, "MM", "Maximum error either way", machining::kLengthRange);
    const std::optional<double>& inner =
        t.optional_number("--inner-tolerance", "MM", "Maximum over-cut, if it differs", machining::kLengthRange);
    const std::optional<double>& outer =
        t.optional_number("--outer-tolerance", "MM", "Maximum material left, if it differs", machining::kLengthRange);
    const double& neutral = t.number("--neutral", 0.1, "SHARE",
                                     "Half-width of the neutral band, as a fraction of both tolerances: smaller errors "
                                     "are neither over-cut nor material left",
                                     core::Range::between(0, 1));
    const std::string& method = t.choice("--method", "patch", {"patch", "closest"},
                                         "closest: judge by the distance of the patch's centre from the closest point "
                                         "of the design; the report gives the distance of the two");
    const std::optional<double>& step = t.optional_number(
        "--step", "MM", "Sample the machined surface from above on a grid, too: its step", machining::kLengthRange);
    const std::string& csv = t.optional_output("--csv", "Data sheet: triangle, centre, d, mu, class", {"csv"});
    const std::string& z_errors =
        t.optional_output("--z-errors", "Errors along Z at the machined vertices", cloud::cloud_formats());
    const std::string& path_file =
        t.optional_file("--correct", "PATH", "The path of fettle-mill: to be corrected by the errors");
    const std::string& corrected = t.optional_output(
        "--corrected", "The corrected path: of a program a program, of points the tips", {}, &path_file);
    const std::string& cutter = t.text("--cutter", "", "CUTTER", "The cutter that machined along PATH");
    machining::ToolPathOptions path{t};
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-mill programs/pocket.nc --stock box:0,0,-12,80,60,0 --cutter ball:6 --step 0.25 | fettle-verify "
              "--design <(fettle-mill programs/pocket.nc --stock box:0,0,-12,80,60,0 --cutter ball:5.9 --step 0.5) "
              "--tolerance 0.03 --csv sheet.csv > patches.pcd",
              "a cutter that is 0.1 mm too thick cuts walls too wide");
    t.reference("Guan & Xiong, Virtual machining accuracy verification by triangular patch comparison: eq. 4 to 6");
}

/// The patches in the tilted frame, judged by the tolerances.
machining::PatchVerdict judge(const Options& o, const mesh::Mesh& machined, const machining::PartMesh& design)
{
    machining::PatchVerdict verdict;
    verdict.tolerances = {o.inner.value_or(o.tolerance), o.outer.value_or(o.tolerance), o.neutral};
    verdict.patches = machining::patch_errors(machined, design.mesh);
    verdict.use_closest_point = o.method == "closest";
    if (verdict.use_closest_point)
        verdict.closest = machining::closest_errors(verdict.patches, design.mesh, design.closed);
    return verdict;
}

/// Corrects the path by the errors, and writes it. @param R_machine_tilted  from the frame of the meshes
machining::CorrectedPath correct_path(const Options& o, const mesh::Mesh& machined, const mesh::Mesh& design,
                                      const machining::PatchVerdict& verdict, const Eigen::Matrix3d& R_machine_tilted)
{
    const machining::Cutter cutter = machining::parse_cutter_option(o.cutter);
    const machining::ToolPath path = o.path.read(o.path_file, cutter);
    if (const std::string doubt = machining::unit_warning(path.program); !doubt.empty())
        o.t.warn(core::display_name(o.path_file) + ": " + doubt);
    machining::CorrectedPath corrected =
        machining::correct(path.program.moves, cutter, machined, design, verdict.patches, verdict.tolerances.outer);
    if (path.points)
        o.out.write(
            o.corrected,
            machining::rotated(machining::corrected_points(path, corrected, o.path.contacts()), R_machine_tilted),
            units::Units{});
    else
        machining::write_corrected(o.t.output_file(o.corrected), path, corrected);
    return corrected;
}

void warn_of_meshes(const Options& o, const machining::PartMesh& machined, const machining::PartMesh& design)
{
    for (const machining::PartMesh* part : {&machined, &design})
        for (const std::string& warning : part->warnings) o.t.warn(warning);
    constexpr double kMaxRatio = 100; // a part of a design, or a design of a part of the machined surface
    const Eigen::AlignedBox3d box = geometry::finite_bounding_box(machined.mesh.vertices);
    const Eigen::AlignedBox3d design_box = geometry::finite_bounding_box(design.mesh.vertices);
    const std::string doubt =
        job::scale_warning("the machined surface", box.sizes(), units::Units{},
                           {"the design", design_box.sizes().head<2>().norm(), 1 / kMaxRatio, kMaxRatio});
    if (!doubt.empty()) o.t.warn(core::display_name(o.machined) + ": " + doubt);
    const std::string size = job::size_warning(design_box, design.mesh.vertices.cols(), units::Units{});
    if (!size.empty()) o.t.warn(core::display_name(o.design) + ": " + size);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        if (o.path_file.empty() != o.corrected.empty() || o.path_file.empty() != o.cutter.empty())
            throw core::InputError("--correct, --corrected and --cutter belong together");

        const Eigen::Matrix3d R_tilted_machine = machining::rotation_tilted_machine(o.path.axis());
        const Eigen::Matrix3d R_machine_tilted = R_tilted_machine.transpose();
        const machining::PartMesh machined_part =
            machining::read_machined_surface(o.machined, o.unit, o.step, R_tilted_machine);
        const machining::PartMesh design_part = machining::read_design(o.design, o.design_unit, R_tilted_machine);
        const mesh::Mesh &machined = machined_part.mesh, &design = design_part.mesh;
        machining::PatchVerdict verdict = judge(o, machined, design_part);
        std::optional<machining::CorrectedPath> corrected;
        if (!o.path_file.empty()) corrected = correct_path(o, machined, design, verdict, R_machine_tilted);

        if (!o.z_errors.empty())
            o.out.write(
                o.z_errors,
                machining::rotated(machining::z_errors_to_cloud(machined, verdict.patches.z_error), R_machine_tilted),
                units::Units{});
        verdict.patches = machining::rotated(std::move(verdict.patches), R_machine_tilted);
        if (!o.csv.empty()) machining::write_csv(t.output_file(o.csv), verdict);
        o.out.write(machining::to_cloud(verdict), units::Units{});
        t.report() = machining::to_json(verdict);
        if (corrected) t.report().set("correction", machining::to_json(*corrected));
        warn_of_meshes(o, machined_part, design_part);
        const auto undefined = verdict.error().array().isNaN().count();
        if (undefined > 0)
            t.warn(core::display_name(o.machined) + ": " + std::to_string(undefined) + " of " +
                   std::to_string(verdict.error().size()) + " patches have no error: see \"undefined_by_patch\"");
        const bool accepted = machining::count_over_cut(verdict) == 0 && undefined < verdict.error().size();
        return accepted ? cli::Verdict::yes : cli::Verdict::no;
    });
}
