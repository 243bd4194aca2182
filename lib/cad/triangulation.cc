#include "cad/triangulation.h"

#include "cad/deviation.h"
#include "cad/refinement.h"
#include "cad/shapes.h"
#include "core/error.h"
#include "core/text.h"
#include "mesh/equal_corners.h"

#include <Bnd_Box.hxx>
#include <BRep_Tool.hxx>
#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <ostream>

namespace fettle::cad {
namespace {

// Deflection of the edges, in tolerances: OpenCASCADE measures edges by samples, and now and then exceeds it.
constexpr double kFirstDeflection = 0.8;
// Deflection inside the faces, in that of the edges. A coarse start is enough: refine_triangles() makes of it what is
// needed, in a fifth of the time that OpenCASCADE takes for a B-spline surface.
constexpr double kInnerDeflection = 10;
constexpr double kGoal = 0.99;    // of the tolerance: the rest is for the rounding of coordinates to float
constexpr double kSnap = 0x1p-20; // mm: points that OpenCASCADE calls one are closer than 1e-7 mm
constexpr double kFiner = 0.5;
constexpr int kMaxRounds = 5;    // then a twentieth of the tolerance: what is not within it never is
constexpr double kMaxTurn = 0.5; // between neighbouring chords, rad, as OpenCASCADE's default

void mesh_part(const TopoDS_Shape& part, double deflection)
{
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    parameters.DeflectionInterior = kInnerDeflection * deflection;
    parameters.Angle = kMaxTurn;
    parameters.MinSize = deflection / 10;
    parameters.InParallel = true;
    BRepTools::Clean(part);
    BRepMesh_IncrementalMesh(part, parameters);
}

/// The face's triangles, or nothing.
Handle(Poly_Triangulation) triangles_of(const TopoDS_Face& face, TopLoc_Location& location)
{
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
    return triangles.IsNull() || triangles->NbTriangles() == 0 ? Handle(Poly_Triangulation)() : triangles;
}

/// Triangulates a part, finer and finer until all its edges are within the tolerance or no finer is tried; then refines
/// its faces until they are.
void mesh_within(const TopoDS_Shape& part, double tolerance)
{
    std::vector<TopoDS_Face> faces;
    for (TopExp_Explorer face(part, TopAbs_FACE); face.More(); face.Next())
        faces.push_back(TopoDS::Face(face.Current()));
    const auto is_triangulated = [](const TopoDS_Face& face) {
        TopLoc_Location location;
        return !triangles_of(face, location).IsNull();
    };
    double deflection = kFirstDeflection * tolerance;
    for (int round = 0; round < kMaxRounds; ++round, deflection *= kFiner) {
        mesh_part(part, deflection);
        if (std::ranges::all_of(faces, [&](const TopoDS_Face& face) {
                return is_triangulated(face) && edges_bound(face, tolerance) <= tolerance;
            }))
            break;
    }
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
        if (is_triangulated(faces[i])) refine_triangles(faces[i], tolerance);
    });
}

/// As written: equal for points that are one but for rounding, as a pole seen from different sides is.
mesh::Corner<float> snapped(const gp_Pnt& p)
{
    const auto snap = [](double x) { return static_cast<float>(std::round(x / kSnap) * kSnap + 0.0); }; // no -0
    return {snap(p.X()), snap(p.Y()), snap(p.Z())};
}

/// Appends the corners of the triangles, counter-clockwise seen from outside, but for those whose corners are only two.
void append_corners(const TopoDS_Face& face, std::vector<mesh::Corner<float>>& corners)
{
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = triangles_of(face, location);
    const gp_Trsf& placing = location.Transformation();
    const bool is_turned = (face.Orientation() == TopAbs_REVERSED) != placing.IsNegative();
    for (int i = 1; i <= triangles->NbTriangles(); ++i) {
        std::array<mesh::Corner<float>, 3> t;
        for (int k = 0; k < 3; ++k)
            t[static_cast<std::size_t>(is_turned ? 2 - k : k)] =
                snapped(triangles->Node(triangles->Triangle(i).Value(k + 1)).Transformed(placing));
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) corners.insert(corners.end(), t.begin(), t.end());
    }
}

/// Half the spacing of floats at a coordinate and half of kSnap, in the worst direction, mm.
double rounding_at(float coordinate)
{
    return std::sqrt(3.0) / 2 *
           (std::nextafter(coordinate, std::numeric_limits<float>::infinity()) - coordinate + kSnap);
}

/// A tolerance for which the rounding of coordinates leaves no room could take all memory, to be missed in the end.
void require_room_for_rounding(const Shapes& shapes, double tolerance)
{
    Bnd_Box box;
    for (const TopoDS_Shape& face : shapes.placed) BRepBndLib::AddClose(face, box);
    if (box.IsVoid()) return;
    const gp_Pnt min = box.CornerMin(), max = box.CornerMax();
    double largest = 0;
    for (int k = 1; k <= 3; ++k) largest = std::max({largest, std::abs(min.Coord(k)), std::abs(max.Coord(k))});
    const bool is_flat = std::ranges::all_of(shapes.faces, [](const Face& face) { return face.surface == "plane"; });
    const double finest = rounding_at(static_cast<float>(largest)) / (is_flat ? 1 : 1 - kGoal);
    if (tolerance < finest)
        throw core::InputError(shapes.source, "reaches to " + core::to_short_text(largest) +
                                                  " mm, where the floats of the output allow no tolerance under " +
                                                  core::to_short_text(finest) + " mm, got " +
                                                  core::to_short_text(tolerance) + " mm");
}

double rounding_of(const std::vector<mesh::Corner<float>>& corners)
{
    float largest = 0;
    for (const mesh::Corner<float>& corner : corners)
        for (const float x : corner) largest = std::max(largest, std::abs(x));
    return rounding_at(largest);
}

/// Edges that are not those of two triangles, one in each direction.
Eigen::Index count_open_edges(const Eigen::Matrix3Xi& triangles)
{
    std::vector<std::pair<int, int>> edges;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k) edges.emplace_back(triangles(k, t), triangles((k + 1) % 3, t));
    std::ranges::sort(edges);
    return std::ranges::count_if(edges, [&](const std::pair<int, int>& edge) {
        const auto there = std::ranges::equal_range(edges, edge);
        const auto back = std::ranges::equal_range(edges, std::pair(edge.second, edge.first));
        return there.size() != 1 || back.size() != 1;
    });
}

} // namespace

Triangulation triangulate(const Design& design, double tolerance, const core::Progress& progress)
{
    const Shapes& shapes = design.shapes();
    Triangulation result;
    std::vector<mesh::Corner<float>> corners;
    try {
        require_room_for_rounding(shapes, tolerance);
        for (std::size_t i = 0; i < shapes.parts.size(); ++i) {
            mesh_within(shapes.parts[i], kGoal * tolerance);
            core::report_progress(progress, double(i + 1) / double(shapes.parts.size()));
        }
        for (std::size_t i = 0; i < shapes.placed.size(); ++i) {
            TopLoc_Location location;
            if (triangles_of(shapes.placed[i], location).IsNull())
                throw core::InputError(shapes.source, design.describe(i) + " cannot be triangulated");
            const std::size_t before = corners.size();
            append_corners(shapes.placed[i], corners);
            result.triangles.push_back(static_cast<Eigen::Index>(corners.size() - before) / 3);
            result.face_of.resize(corners.size() / 3, static_cast<int>(i));
        }
        const double rounding = rounding_of(corners);
        result.deviation.resize(shapes.placed.size());
        tbb::parallel_for(std::size_t{0}, shapes.placed.size(), [&](std::size_t i) {
            result.deviation[i] = deviation_bound(shapes.placed[i], kGoal * tolerance) + rounding;
        });
    } catch (const Standard_Failure& failure) {
        throw core::InputError(shapes.source,
                               std::string("OpenCASCADE cannot triangulate it: ") + failure.GetMessageString());
    }
    for (std::size_t i = 0; i < result.deviation.size(); ++i)
        if (!(result.deviation[i] <= tolerance))
            throw core::InputError(shapes.source, design.describe(i) + " is triangulated to " +
                                                      core::to_short_text(result.deviation[i]) + " mm only, not to " +
                                                      core::to_short_text(tolerance) + " mm");
    mesh::MeshRepair repair;
    result.mesh = mesh::weld_facets<float>(
        corners.size() / 3,
        [&](std::size_t first, std::size_t count, mesh::Corner<float>* to) {
            std::copy_n(corners.begin() + static_cast<std::ptrdiff_t>(3 * first), 3 * count, to);
        },
        repair);
    if (repair.dropped_triangles > 0) throw core::InputError(shapes.source, "has facets whose corners are not finite");
    result.open_edges = count_open_edges(result.mesh.triangles);
    return result;
}

void write_faces_ply(std::ostream& out, const Design& design, const Triangulation& triangulation,
                     units::Units::Length unit)
{
    const mesh::Mesh& mesh = triangulation.mesh;
    const bool is_coloured =
        std::ranges::any_of(design.faces(), [](const Face& face) { return face.colour.has_value(); });
    out << "ply\nformat binary_little_endian 1.0\ncomment units " << units::to_string(unit) << "\nelement vertex "
        << mesh.vertices.cols() << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
        << mesh.triangles.cols() << "\nproperty list uchar int vertex_indices\nproperty int face\n"
        << (is_coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "") << "end_header\n";
    const Eigen::Matrix3Xf vertices = (mesh.vertices / units::mm_per(unit)).cast<float>();
    out.write(reinterpret_cast<const char*>(vertices.data()),
              static_cast<std::streamsize>(sizeof(float) * vertices.size()));
    const std::size_t bytes = 1 + 4 * sizeof(std::int32_t) + (is_coloured ? 3 : 0);
    std::vector<char> faces(bytes * static_cast<std::size_t>(mesh.triangles.cols()));
    char* to = faces.data();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t, to += bytes) {
        const std::int32_t face = triangulation.face_of[static_cast<std::size_t>(t)];
        *to = 3;
        std::memcpy(to + 1, mesh.triangles.col(t).data(), 3 * sizeof(std::int32_t));
        std::memcpy(to + 13, &face, sizeof face);
        if (is_coloured)
            std::ranges::copy(design.faces()[static_cast<std::size_t>(face)].colour.value_or(
                                  std::array<std::uint8_t, 3>{255, 255, 255}),
                              to + 17);
    }
    out.write(faces.data(), static_cast<std::streamsize>(faces.size()));
}

} // namespace fettle::cad
