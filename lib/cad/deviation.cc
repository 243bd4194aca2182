#include "cad/deviation.h"

#include "cad/face_triangle.h"
#include "cad/point.h"
#include "mesh/triangle.h"

#include <BRep_Tool.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle::cad {
namespace {

constexpr int kMaxChordHalvings = 5; // as of triangles

/// Bound of the distances between an edge and one of its chords.
double chord_bound(const BRepAdaptor_Curve& curve, double t0, double t1, double tolerance)
{
    double bound = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d a = vector_of(curve.Value(t0)), b = vector_of(curve.Value(t1));
    const Eigen::Matrix3d chord = (Eigen::Matrix3d() << a, b, b).finished();
    for (int halvings = 1; halvings <= kMaxChordHalvings && bound > tolerance; ++halvings) {
        const int n = 1 << halvings;
        std::vector<Eigen::Vector3d> points;
        double squared_distance = 0, second_difference = 0;
        for (int i = 0; i <= n; ++i) {
            points.push_back(vector_of(curve.Value(t0 + (t1 - t0) * i / n)));
            squared_distance =
                std::max(squared_distance, mesh::closest_on_triangle(chord, points.back()).squared_distance);
            if (i >= 2)
                second_difference = std::max(second_difference, (points[i] - 2 * points[i - 1] + points[i - 2]).norm());
        }
        bound = std::min(bound, std::sqrt(squared_distance) + second_difference / 8);
    }
    return bound;
}

} // namespace

double edges_bound(const TopoDS_Face& face, double tolerance)
{
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    double bound = 0;
    for (TopExp_Explorer explorer(face, TopAbs_EDGE); explorer.More(); explorer.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(explorer.Current());
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
        if (BRep_Tool::Degenerated(edge) || polygon.IsNull() || !polygon->HasParameters()) continue;
        const BRepAdaptor_Curve curve(edge);
        const TColStd_Array1OfReal& t = polygon->Parameters()->Array1();
        for (int i = t.Lower(); i < t.Upper(); ++i)
            bound = std::max(bound, chord_bound(curve, t(i), t(i + 1), tolerance));
    }
    return bound;
}

std::vector<FaceTriangle> triangles_of(const TopoDS_Face& face, const Adaptor3d_Surface& surface)
{
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    const gp_Trsf& placing = location.Transformation();
    std::vector<FaceTriangle> triangles;
    triangles.reserve(static_cast<std::size_t>(triangulation->NbTriangles()));
    for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
        mesh::Triangle corners;
        Eigen::Matrix<double, 2, 3> uv;
        for (int k = 0; k < 3; ++k) {
            const int node = triangulation->Triangle(i).Value(k + 1);
            const gp_Pnt2d parameters = triangulation->UVNode(node);
            corners.col(k) = vector_of(triangulation->Node(node).Transformed(placing));
            uv.col(k) << parameters.X(), parameters.Y();
        }
        triangles.push_back(face_triangle(surface, corners, uv));
    }
    return triangles;
}

double deviation_bound(const TopoDS_Face& face, double tolerance)
{
    const BRepAdaptor_Surface surface(face, false);
    const std::vector<FaceTriangle> triangles = triangles_of(face, surface);
    const auto bound_with = [&](Correspondence correspondence) {
        double bound = 0;
        for (const FaceTriangle& t : triangles)
            if (bound = std::max(bound, triangle_bound(surface, t, tolerance, correspondence)); bound > tolerance)
                break;
        return bound;
    };
    double bound = bound_with(Correspondence::by_parameters);
    if (bound > tolerance) bound = bound_with(Correspondence::closest_point);
    return std::max(bound, edges_bound(face, tolerance));
}

} // namespace fettle::cad
