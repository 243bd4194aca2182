#include "cad/pieces.h"

#include "cad/deviation.h"
#include "cad/point.h"
#include "cad/shapes.h"

#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle::cad {
namespace {

constexpr double kPointTolerance = 1e-7; // mm: OpenCASCADE's own tolerance of points

/// +1, or -1 if the outward side is that of -du x dv.
double outward_sign(const TopoDS_Face& face)
{
    return (face.Orientation() == TopAbs_REVERSED) != face.Location().Transformation().IsNegative() ? -1 : 1;
}

/// Sum of the normals of the triangles at a place, weighted by their angles there, on the side of du x dv.
Eigen::Vector3d sum_of_normals(const std::vector<FaceTriangle>& triangles, const Eigen::Vector3d& place)
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const FaceTriangle& t : triangles)
        for (int k = 0; k < 3; ++k) {
            if ((t.corners.col(k) - place).norm() > kPointTolerance) continue;
            const Eigen::Vector3d a = t.corners.col((k + 1) % 3) - place, b = t.corners.col((k + 2) % 3) - place;
            const Eigen::Vector3d cross = a.cross(b);
            if (cross.norm() > 0) sum += std::atan2(cross.norm(), a.dot(b)) * cross.normalized();
        }
    return sum;
}

Eigen::Vector3d placed(const TopoDS_Vertex& vertex) { return vector_of(BRep_Tool::Pnt(vertex)); }

void add_chords(const TopoDS_Face& face, Border border, const std::vector<FaceTriangle>& triangles, double sign,
                Pieces& pieces)
{
    const auto number = static_cast<std::uint32_t>(pieces.borders.size());
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    if (border.is_pole) {
        const TopoDS_Vertex vertex = TopExp::FirstVertex(border.edge);
        if (vertex.IsNull()) return;
        const Eigen::Vector3d place = placed(vertex);
        border.pole_normal = sign * sum_of_normals(triangles, place);
        pieces.chords.push_back({number, 0, 0, place, place});
    } else {
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(border.edge, triangulation, location);
        if (polygon.IsNull() || !polygon->HasParameters()) return;
        const BRepAdaptor_Curve curve(border.edge);
        const TColStd_Array1OfReal& t = polygon->Parameters()->Array1();
        for (int i = t.Lower(); i < t.Upper(); ++i)
            pieces.chords.push_back(
                {number, t(i), t(i + 1), vector_of(curve.Value(t(i))), vector_of(curve.Value(t(i + 1)))});
    }
    pieces.borders.push_back(std::move(border));
}

void add_borders(const TopoDS_Face& face, int number, const std::vector<FaceTriangle>& triangles, Pieces& pieces)
{
    const double sign = outward_sign(face);
    const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
    for (TopExp_Explorer explorer(forward, TopAbs_EDGE); explorer.More(); explorer.Next()) {
        Border border;
        border.face = number;
        border.edge = TopoDS::Edge(explorer.Current());
        if (border.edge.Orientation() == TopAbs_INTERNAL || border.edge.Orientation() == TopAbs_EXTERNAL) continue;
        double first = 0, last = 0;
        border.parameters = BRep_Tool::CurveOnSurface(border.edge, forward, first, last);
        border.is_reversed = border.edge.Orientation() == TopAbs_REVERSED;
        border.is_seam = BRep_Tool::IsClosed(border.edge, forward);
        border.is_pole = BRep_Tool::Degenerated(border.edge);
        border.tolerance = BRep_Tool::Tolerance(border.edge);
        for (TopExp_Explorer vertex(border.edge, TopAbs_VERTEX); vertex.More(); vertex.Next())
            border.tolerance = std::max(border.tolerance, BRep_Tool::Tolerance(TopoDS::Vertex(vertex.Current())));
        add_chords(face, std::move(border), triangles, sign, pieces);
    }
}

Pieces::Box box_of(const Eigen::AlignedBox3d& box)
{
    const Eigen::Vector3d &a = box.min(), &b = box.max();
    return {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}};
}

} // namespace

Pieces pieces_of(const Design& design)
{
    Pieces pieces;
    const std::vector<TopoDS_Face>& faces = design.shapes().placed;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const std::vector<FaceTriangle> triangles = triangles_of(faces[i], BRepAdaptor_Surface(faces[i], false));
        add_borders(faces[i], static_cast<int>(i), triangles, pieces);
        pieces.triangles.insert(pieces.triangles.end(), triangles.begin(), triangles.end());
        pieces.face_of_triangle.resize(pieces.triangles.size(), static_cast<int>(i));
    }
    std::vector<Pieces::Entry> entries;
    for (const FaceTriangle& t : pieces.triangles) {
        Eigen::AlignedBox3d box;
        for (const Eigen::Vector3d& corner : t.corners.colwise()) box.extend(corner);
        entries.emplace_back(box_of(box), static_cast<std::uint32_t>(entries.size()));
    }
    for (const Chord& chord : pieces.chords)
        entries.emplace_back(box_of(Eigen::AlignedBox3d(chord.a).extend(chord.b)),
                             static_cast<std::uint32_t>(entries.size()));
    pieces.index = Pieces::Index(entries);
    return pieces;
}

Evaluators::Evaluators(const Design& design, const Pieces& pieces)
    : design_(design), pieces_(pieces), surfaces_(design.faces().size()), curves_(pieces.borders.size())
{
}

const BRepAdaptor_Surface& Evaluators::surface(int face)
{
    auto& surface = surfaces_[static_cast<std::size_t>(face)];
    if (!surface)
        surface = std::make_unique<BRepAdaptor_Surface>(design_.shapes().placed[static_cast<std::size_t>(face)], false);
    return *surface;
}

const BRepAdaptor_Curve& Evaluators::curve(std::uint32_t border)
{
    auto& curve = curves_[border];
    if (!curve) curve = std::make_unique<BRepAdaptor_Curve>(pieces_.borders[border].edge);
    return *curve;
}

Eigen::Vector3d Evaluators::normal(int face, const Eigen::Vector2d& uv)
{
    gp_Pnt point;
    gp_Vec du, dv;
    surface(face).D1(uv.x(), uv.y(), point, du, dv);
    const Eigen::Vector3d u = vector_of(du), v = vector_of(dv), cross = u.cross(v);
    constexpr double kMinSine = 1e-9; // between them, and of one to the other: a pole, of which rounding leaves a rest
    const double longer = std::max(u.squaredNorm(), v.squaredNorm());
    if (!(cross.norm() > kMinSine * longer)) return Eigen::Vector3d::Zero();
    return outward_sign(design_.shapes().placed[static_cast<std::size_t>(face)]) * cross.normalized();
}

Eigen::Vector3d Evaluators::tangent(std::uint32_t border, double t)
{
    gp_Pnt point;
    gp_Vec along;
    curve(border).D1(t, point, along);
    return vector_of(along).normalized();
}

} // namespace fettle::cad
