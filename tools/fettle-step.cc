#include "cad/exact_distance.h"
#include "cad/triangulation.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "draw/colours.h"
#include "geometry/bounding_box.h"
#include "geometry/statistics.h"
#include "job/plausible.h"
#include "mesh/cloud_mesh.h"
#include "mesh/mesh_file.h"
#include "mesh/shape_file.h"

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

/// Warns of what is left out, open, or of a size that is hardly meant.
void warn_of(const cli::Tool& t, const std::string& name, const cad::Design& design, const cad::Triangulation& result,
             units::Units::Length unit)
{
    if (design.loose_faces() > 0)
        t.warn(name + ": " + std::to_string(design.loose_faces()) + " faces belong to no solid, and were left out");
    const Eigen::Matrix3Xd& vertices = result.mesh.vertices;
    const std::string doubt = job::size_warning(geometry::finite_bounding_box(vertices), vertices.cols(), {unit});
    if (!doubt.empty()) t.warn(name + ": " + doubt);
    if (result.open_edges > 0)
        t.warn(name + ": " + std::to_string(result.open_edges) + " edges of triangles do not join two of them");
}

void report_design(json::Value& report, const cad::Design& design, const cad::Triangulation& result, double mm)
{
    std::vector<json::Value> faces;
    for (std::size_t i = 0; i < design.faces().size(); ++i)
        faces.push_back(face_report(design.faces()[i], result.triangles[i], result.deviation[i] / mm));
    report.set("file_unit", design.file_unit()).set("solids", design.solids());
    report.set("triangles", result.mesh.triangles.cols()).set("open_edges", result.open_edges);
    report.set("deviation", *std::ranges::max_element(result.deviation) / mm).set("faces", faces);
}

/// The points of a part that is compared with the design, with its fields; of a mesh the vertices, mm.
cloud::Cloud part_points(const std::string& path, units::Units::Length unit)
{
    mesh::ShapeFile file = mesh::read_shape(path, units::Units{unit});
    if (mesh::frame_of(file.shape) == cloud::Frame::job)
        throw core::InputError(core::display_name(path),
                               "is in the frame of its job: fettle-place --into JOB --inverse moves it back");
    if (cloud::Cloud* points = std::get_if<cloud::Cloud>(&file.shape)) return std::move(*points);
    cloud::Cloud points;
    points.xyz = mesh::coordinates_of(file.shape);
    return points;
}

/// Adds the distances to the points, coloured, and their statistics to the report.
void set_distances(cloud::Cloud& points, const cad::ExactDistances& distances, json::Value& report, double mm)
{
    cloud::set_normals(points, distances.normal);
    cloud::set_field(points, "error", distances.error, 8);
    cloud::set_field(points, "face", distances.face.cast<double>());
    cloud::set_colours(points, draw::colours(draw::colour_scale(distances.error, 0), distances.error));
    const geometry::Statistics s =
        geometry::statistics(distances.error, Eigen::VectorXd::Zero(distances.error.size()), std::nullopt);
    report.set("count", s.count).set("undefined", s.undefined);
    for (const auto& [key, length] : std::initializer_list<std::pair<const char*, double>>{
             {"mean", s.mean}, {"mean_abs", s.mean_abs}, {"rms", s.rms}, {"sd", s.sd}, {"min", s.min}, {"max", s.max}})
        report.set(key, length / mm);
}

/// The format to write, by what is asked for.
std::string required_format(const std::string& format, bool is_exact)
{
    if (format.empty()) return is_exact ? "pcd" : "stl";
    if (format != "ply" && (format == "stl") == is_exact)
        throw core::InputError("--exact", is_exact ? "writes points: .pcd, .ply, .csv or .vtk, not ." + format
                                                   : "is what writes ." + format + "; triangles go to .stl or .ply");
    return format;
}

const std::string kDescription =
    "Turn a design as CAD writes it into triangles with a stated deviation, or measure a part against it.\n"
    "Reads STEP (AP203, AP214, AP242) and IGES, with the unit that the file states; assemblies are placed. Every face "
    "is triangulated so that its triangles, surface and edges are nowhere farther apart than the tolerance, which is "
    "computed; a face for which that fails is named, and nothing is written. A PLY file has for each triangle the "
    "number of its face, and the colours of the faces; names are in the report. With --exact out come the points of a "
    "part with their distances to the design's surfaces themselves, not to triangles (error, + material left), the "
    "outward normal there, and the number of the face.";

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const std::string& path = t.main_input("DESIGN", "STEP or IGES");
        const double& stated = t.number("--tolerance", 0.01, "LENGTH",
                                        "Largest deviation of the triangles, in the unit of the output; with --exact "
                                        "they only lead the search",
                                        core::Range::positive());
        const std::string& part =
            t.optional_file("--exact", "PART",
                            "Measure the points of a cloud, or the vertices of a mesh; its unit is that of the output");
        const units::Units::Length& unit = t.choice<units::Units::Length>(
            "--units",
            {{"mm", units::Units::Length::mm}, {"in", units::Units::Length::in}, {"m", units::Units::Length::m}},
            "Unit of the output");
        const std::string& stated_format =
            t.output_format({"stl", "ply", "pcd", "csv", "vtk"}, "stl; with --exact pcd");
        t.example("fettle-step designs/clamp.step --tolerance 0.1 --report faces.json -o clamp.ply",
                  "the design as triangles, none farther than 0.1 mm from it");
        t.reference("ISO 10303-21; IGES 5.3; OpenCASCADE reads and triangulates; feet by Newton's method (Hu & Wallner "
                    "2005)");
        t.parse();
        const std::string format = required_format(stated_format, !part.empty());
        const double mm = units::mm_per(unit), tolerance = stated * mm;
        cloud::Cloud points;
        if (!part.empty()) points = part_points(part, unit);

        const cad::Design design = cad::read_design(path, tolerance);
        const cad::Triangulation result = cad::triangulate(design, tolerance, t.progress("triangulating"));
        warn_of(t, core::display_name(path), design, result, unit);
        t.report().set("tolerance", stated);
        report_design(t.report(), design, result, mm);
        if (!part.empty()) {
            set_distances(points, cad::ExactDistance(design, result)(points.xyz, t.progress("measuring")), t.report(),
                          mm);
            cloud::CloudWriter writer(t.output(), cloud::cloud_format(format, false), {unit},
                                      static_cast<std::size_t>(points.size()));
            writer.write(points);
            writer.finish();
        } else if (format == "ply") {
            cad::write_faces_ply(t.output(), design, result, unit);
        } else {
            mesh::write_stl(t.output(), result.mesh, unit);
        }
        return cli::Verdict::yes;
    });
}
