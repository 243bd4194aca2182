#include "cad/triangulation.h"
#include "cli/tool.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "job/plausible.h"
#include "mesh/cloud_mesh.h"
#include "mesh/mesh_file.h"

#include <algorithm>

using namespace fettle;

namespace {

json::Value face_report(const cad::Face& face, Eigen::Index triangles, double deviation)
{
    json::Value row;
    row.set("part", face.part).set("name", face.name).set("surface", face.surface);
    if (face.colour)
        row.set("colour", Eigen::VectorXd(
                              Eigen::Map<const Eigen::Matrix<std::uint8_t, 3, 1>>(face.colour->data()).cast<double>()));
    row.set("triangles", triangles).set("deviation", deviation);
    return row;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Turn a design as CAD writes it into triangles with a stated deviation.\n"
        "Reads STEP (AP203, AP214, AP242) and IGES, with the unit that the file states; assemblies are placed. Every "
        "face "
        "is triangulated so that its triangles, surface and edges are nowhere farther apart than the tolerance, which "
        "is "
        "computed; a face for which that fails is named, and nothing is written. A PLY file has for each triangle the "
        "number of its face, and the colours of the faces; names are in the report.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& path = t.main_input("DESIGN", "STEP or IGES");
        const double& stated = t.number("--tolerance", 0.01, "LENGTH", "Largest deviation, in the unit of the output",
                                        core::Range::positive());
        const units::Units::Length& unit = t.choice<units::Units::Length>(
            "--units",
            {{"mm", units::Units::Length::mm}, {"in", units::Units::Length::in}, {"m", units::Units::Length::m}},
            "Unit of the output");
        const std::string& format = t.output_format({"stl", "ply"});
        t.example("fettle-step designs/clamp.step --tolerance 0.1 --report faces.json -o clamp.ply",
                  "the design as triangles, none farther than 0.1 mm from it");
        t.reference("ISO 10303-21; IGES 5.3; OpenCASCADE reads and triangulates");
        t.parse();
        const std::string name = core::display_name(path);
        const mesh::PartFormat written = mesh::part_format(t.output_name(), format, true);
        const double mm = units::mm_per(unit), tolerance = stated * mm;

        const cad::Design design = cad::read_design(path, tolerance);
        if (design.loose_faces() > 0)
            t.warn(name + ": " + std::to_string(design.loose_faces()) + " faces belong to no solid, and were left out");
        const cad::Triangulation result = cad::triangulate(design, tolerance, t.progress("triangulating"));
        const Eigen::Matrix3Xd& vertices = result.mesh.vertices;
        const std::string doubt = job::size_warning(geometry::finite_bounding_box(vertices), vertices.cols(), {unit});
        if (!doubt.empty()) t.warn(name + ": " + doubt);
        if (result.open_edges > 0)
            t.warn(name + ": " + std::to_string(result.open_edges) + " edges of triangles do not join two of them");

        std::vector<json::Value> faces;
        for (std::size_t i = 0; i < design.faces().size(); ++i)
            faces.push_back(face_report(design.faces()[i], result.triangles[i], result.deviation[i] / mm));
        t.report().set("file_unit", design.file_unit()).set("solids", design.solids());
        t.report().set("triangles", result.mesh.triangles.cols()).set("open_edges", result.open_edges);
        t.report().set("tolerance", stated).set("deviation", *std::ranges::max_element(result.deviation) / mm);
        t.report().set("faces", faces);
        if (written == mesh::PartFormat::ply)
            cad::write_faces_ply(t.output(), design, result, unit);
        else
            mesh::write_stl(t.output(), result.mesh, unit);
        return cli::Verdict::yes;
    });
}
