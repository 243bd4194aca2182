#include "cli/tool.h"
#include "core/file.h"
#include "core/text.h"
#include "job/shape_warnings.h"
#include "mesh/part_output.h"
#include "mesh/shape_file.h"
#include "reconstruct/reconstruct.h"

using namespace fettle;

namespace {

/// Three numbers, or nothing for an option that is not given.
std::optional<Eigen::Vector3d> parse_vector(const std::string& option, const std::string& text)
{
    if (text.empty()) return std::nullopt;
    return Eigen::Vector3d(cli::with_error_prefix(option, [&] {
        return core::parse_number_list(text, {"X", "Y", "Z"});
    }));
}

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("CLOUD", "A cloud (PCD, PLY, E57, PTX, XYZ)");
    const std::optional<units::Units::Length>& unit =
        t.length_unit("--file-units", "Unit of CLOUD, if it states none; default: mm");
    const std::optional<double>& max_gap =
        t.optional_number("--max-gap", "LENGTH",
                          "Longest edge of a triangle: wider holes stay open; default: 3 times the spacing of the "
                          "points",
                          core::Range::positive());
    const std::string& facing = t.text("--facing", "", "X,Y,Z", "The surface faces this direction");
    const std::string& from =
        t.text("--from", "", "X,Y,Z", "The scanner stood here, in the unit of CLOUD: the surface faces it");
    const mesh::PartOutput out{t, {"stl", "ply"}};
};

reconstruct::ReconstructRequest parse_request(const Options& o)
{
    reconstruct::ReconstructRequest request;
    request.facing = parse_vector("--facing", o.facing);
    if (request.facing && request.facing->isZero(0)) throw core::InputError("--facing", "a direction is not 0,0,0");
    request.from = parse_vector("--from", o.from);
    if (request.facing && request.from) throw core::InputError("--facing", "goes without --from");
    return request;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Make a mesh of a scan: its points become the vertices of triangles, and holes stay open.\n"
        "No point is moved, added or smoothed, and no triangle spans a gap wider than --max-gap. Organised clouds, and "
        "profiles in the order in which a profiler measured them, are joined along that order; other points by their "
        "nearness. Outside is where the cloud's normals point, else where its viewpoint lies; where a file has "
        "neither, and no option says it, +z for ordered points, else convex.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-reconstruct scans/panel.pcd --report mesh.json -o panel.stl", "a scanned panel as triangles");
        t.reference("Gopi, Krishnan & Silva 2000 (Delaunay stars); Hoppe et al. 1992 (normals); Barequet & Sharir 1995 "
                    "(holes)");
        t.parse();
        reconstruct::ReconstructRequest request = parse_request(o);

        mesh::CloudMeshFile file = mesh::read_cloud_mesh(o.path, mesh::resolve_file_units(o.unit));
        const std::string name = core::display_name(o.path);
        if (file.part.is_mesh()) throw core::InputError(name, "is a mesh already");
        o.out.format_for(true);
        for (const std::string& warning : job::shape_warnings(file, name)) t.warn(warning);
        const double mm = file.units.mm();
        if (request.max_gap = o.max_gap; request.max_gap) *request.max_gap *= mm;
        if (request.from) *request.from *= mm;

        const Eigen::Index points = file.part.points.size();
        const reconstruct::Reconstruction result =
            cli::with_error_prefix(name, [&] { return reconstruct::reconstruct(file.part.points, request); });
        t.report()
            .set("points", points)
            .set("left_out", result.left_out)
            .set("triangles", result.mesh.triangles.cols())
            .set("order", result.order)
            .set("max_gap", result.max_gap / mm)
            .set("outside_by", reconstruct::to_string(result.side))
            .set("filled_holes", result.filled_holes)
            .set("open_borders", result.borders);
        o.out.write(result.mesh, file.units);
        return cli::Verdict::yes;
    });
}
