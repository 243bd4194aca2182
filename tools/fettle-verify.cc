#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/signed_distance.h"
#include "core/direction.h"
#include "core/file.h"
#include "core/text.h"
#include "machining/correction.h"
#include "machining/patch_error.h"
#include "machining/patch_report.h"
#include "machining/tilt.h"
#include "machining/tool_path.h"
#include "machining/workpiece.h"
#include "mesh/mesh_file.h"
#include "sampling/scan.h"

#include <ostream>

using namespace fettle;

namespace {

/// The machined mesh, or its upper side on a grid.
Mesh read_machined(const std::string& path, std::optional<Units::Length> unit, const std::optional<double>& step,
                   const Eigen::Matrix3d& R_tilted_machine)
{
    Mesh mesh = turned(read_mesh(path, unit.value_or(Units::Length::mm)), R_tilted_machine);
    if (!step) return mesh;
    return named("--step", [&] {
        const HeightField field = scanned_workpiece(Scan(std::move(mesh)), *step).stock;
        return surface_between(field, 0, field.rows() - 1);
    });
}

Cloud z_errors(const Mesh& machined, const Eigen::VectorXd& errors)
{
    Cloud cloud;
    cloud.xyz = machined.vertices;
    set_field(cloud, "error", errors);
    return cloud;
}

json::Value to_json(const CorrectedPath& path)
{
    return json::Value()
        .set("moves", path.moves.size())
        .set("shifted", path.shifted)
        .set("held", path.held)
        .set("in_air", path.in_air)
        .set("unknown", path.unknown)
        .set("greatest_shift", path.greatest_shift);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Verifies a machined surface against its design by triangle patches.\n"
        "The design is re-sampled at the x, y of the machined vertices; of each pair of triangles d is the mean of the "
        "three differences along Z, and the error is d along the normal of the design's triangle: + material left. "
        "Where "
        "the design is vertical or not hit, or the machined triangle does not face up, it is undefined: counted and "
        "listed. Out: a point for each patch, coloured bright red, dark red (over-cut), grey, violet, dark blue "
        "(material "
        "left). With --correct also a path that takes the errors back. Lengths in mm. Exit 1 if a patch is over-cut "
        "beyond the tolerance, or none is defined.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& machined_path =
            t.input("MACHINED", "Triangles that face up (fettle-mill): STL, PLY, OBJ or OFF");
        const auto& unit = t.length_unit("--file-units", "Unit of MACHINED, if it is not mm");
        const std::string& design_path = t.required_file("--design", "FILE", "The design: STL, PLY, OBJ or OFF");
        const auto& design_unit = t.length_unit("--design-units", "Unit of the design, if it is not mm");
        const double& tolerance = t.number("-t,--tolerance", 0.05, "MM", "Most error either way", Range::positive());
        const auto& inner =
            t.number_if_given("--inner-tolerance", "MM", "Most over-cut, if another", Range::positive());
        const auto& outer =
            t.number_if_given("--outer-tolerance", "MM", "Most material left, if another", Range::positive());
        const double& neutral =
            t.number("--neutral", 0.1, "SHARE", "Of the tolerances: errors that are neither", Range::between(0, 1));
        const std::string& method = t.choice("--method", "patch", {"patch", "closest"},
                                             "closest: judge by the distance of the patch's centre from the closest "
                                             "point of the design; the report says how far the two are apart");
        const auto& step = t.number_if_given(
            "--step", "MM", "Sample the machined surface from above on such a grid, too", Range::positive());
        const std::string& axis_text =
            t.text("--axis", "0,0,1", "X,Y,Z",
                   "Of the tool that machined (fettle-mill): what is said of Z above goes along it");
        const std::string& csv = t.other_output("--csv", "Data sheet: triangle, centre, d, mu, class");
        const std::string& z_file = t.other_output("--z-errors", "Errors along Z at the machined vertices, PCD");
        const std::string& path_file =
            t.other_file("--correct", "PATH", "What fettle-mill machined along: to be corrected by the errors");
        const std::string& corrected_file = t.other_output(
            "--corrected", "The corrected path: of a program a program, of points a PCD of the tips", &path_file);
        const std::string& cutter_text = t.text("--cutter", "", "CUTTER", "The cutter that machined along PATH");
        const std::string& points = t.choice("--points", "cl", {"cl", "cc"}, "What points of PATH are (fettle-mill)");
        const double& feed = t.number("--feed", 10, "MM/S", "Feed of points without one", Range::positive());
        const bool& ascii = t.flag("--ascii", "Write PCDs as text");
        t.example(
            "fettle-mill programs/pocket.nc --stock box:0,0,-12,80,60,0 --cutter ball:6 --step 0.25 | fettle-verify "
            "--design <(fettle-mill programs/pocket.nc --stock box:0,0,-12,80,60,0 --cutter ball:5.9 --step 0.5) "
            "--tolerance 0.03 --csv sheet.csv > patches.pcd",
            "a cutter that is 0.1 mm too thick cuts walls too wide");
        t.reference("Guan & Xiong, Virtual machining accuracy verification by triangular patch comparison: eq. 4 to 6");
        t.parse();

        const bool corrects = !path_file.empty();
        if (corrects == corrected_file.empty() || corrects == cutter_text.empty())
            throw InputError("--correct, --corrected and --cutter belong together");
        const Eigen::Vector3d axis = parse_direction(axis_text, "--axis");
        const Eigen::Matrix3d R_tilted_machine = rotation_tilted_machine(axis);
        const Eigen::Matrix3d back = R_tilted_machine.transpose();
        const Mesh machined = read_machined(machined_path, unit, step, R_tilted_machine);
        const Mesh design = turned(read_mesh(design_path, design_unit.value_or(Units::Length::mm)), R_tilted_machine);
        PatchVerdict verdict;
        verdict.tolerances = {inner.value_or(tolerance), outer.value_or(tolerance), neutral};
        verdict.patches = patch_errors(machined, design);
        verdict.by_closest = method == "closest";
        if (verdict.by_closest) verdict.closest = signed_distance(verdict.patches.centre, design).error;

        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        const auto write = [&](std::ostream& out, const Cloud& cloud) { write_pcd(out, cloud, Units{}, encoding); };
        std::optional<CorrectedPath> corrected;
        if (corrects) {
            const Cutter cutter = named("--cutter", [&] { return parse_cutter(cutter_text); });
            const ToolPath path =
                parse_tool_path(read_whole(path_file), display_name(path_file), cutter, {points == "cc", feed, axis});
            corrected =
                correct(path.program.moves, cutter, machined, design, verdict.patches, verdict.tolerances.outer);
            if (path.points)
                write(t.output_file(corrected_file), turned(corrected_points(path, *corrected, points == "cc"), back));
            else
                write_corrected(t.output_file(corrected_file), path, *corrected);
        }
        if (!z_file.empty()) write(t.output_file(z_file), turned(z_errors(machined, verdict.patches.z_error), back));
        verdict.patches = turned(std::move(verdict.patches), back);
        if (!csv.empty()) write_csv(t.output_file(csv), verdict);
        write(t.output(), to_cloud(verdict));
        t.report() = to_json(verdict);
        if (corrected) t.report().set("correction", to_json(*corrected));
        const auto undefined = verdict.error().array().isNaN().count();
        if (undefined > 0)
            t.warn(display_name(machined_path) + ": " + std::to_string(undefined) + " of " +
                   std::to_string(verdict.error().size()) + " patches have no error: see \"undefined_by_patch\"");
        return over_cut(verdict) == 0 && undefined < verdict.error().size() ? Verdict::yes : Verdict::no;
    });
}
