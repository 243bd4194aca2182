#include "cad/deviation.h"

#include "cad/foot.h"
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
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle::cad {
namespace {

constexpr int kMaxHalvings = 5; // the second differences of a bulge are then a thousandth of those over one interval

Eigen::Vector3d vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// A triangle of a face, with the parameters of its corners.
struct FaceTriangle {
    mesh::Triangle corners;
    Eigen::Matrix<double, 2, 3> uv;
    /// Where a parameter means nothing, as at the apex of a cone or the pole of a sphere; -1: nowhere. The parameter is
    /// then that of the line from there through a point to the opposite side.
    Eigen::Vector2i singular_corner = {-1, -1};

    Eigen::Vector2d at(const Eigen::Vector3d& barycentric) const
    {
        Eigen::Vector2d parameters = uv * barycentric;
        for (int k = 0; k < 2; ++k)
            if (const int corner = singular_corner[k]; corner >= 0) {
                const int b = (corner + 1) % 3, c = (corner + 2) % 3;
                const double share = barycentric[b] + barycentric[c];
                const double weight = share > 0 ? barycentric[b] / share : 0.5;
                parameters[k] = weight * uv(k, b) + (1 - weight) * uv(k, c);
            }
        return parameters;
    }
};

/// Marks the corners in which the surface stays where it is, whatever one of the parameters.
void find_singular_corners(const Adaptor3d_Surface& surface, FaceTriangle& t)
{
    constexpr double kSame = 1e-7; // mm: OpenCASCADE's own tolerance of points
    for (int k = 0; k < 2; ++k)
        for (int corner = 0; corner < 3; ++corner) {
            Eigen::Vector2d a = t.uv.col(corner), b = a;
            a[k] = t.uv(k, (corner + 1) % 3);
            b[k] = t.uv(k, (corner + 2) % 3);
            const Eigen::Vector3d middle = vector_of(surface.Value((a[0] + b[0]) / 2, (a[1] + b[1]) / 2));
            const Eigen::Vector3d here = t.corners.col(corner);
            if (a[k] != b[k] && (vector_of(surface.Value(a[0], a[1])) - here).norm() < kSame &&
                (vector_of(surface.Value(b[0], b[1])) - here).norm() < kSame && (middle - here).norm() < kSame)
                t.singular_corner[k] = corner;
        }
}

/// Points over the grid of a triangle, (i, j) with i + j <= n.
class TriangleGrid {
  public:
    explicit TriangleGrid(int n) : n_(n), points_(static_cast<std::size_t>((n + 1) * (n + 2) / 2)) {}
    Eigen::Vector3d& at(int i, int j) { return points_[static_cast<std::size_t>(i * (2 * n_ + 3 - i) / 2 + j)]; }

    /// Largest second difference along the three directions of the grid.
    double second_difference()
    {
        double largest = 0;
        const auto add = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
            largest = std::max(largest, (a - 2 * b + c).norm());
        };
        for (int i = 0; i <= n_; ++i)
            for (int j = 0; i + j <= n_; ++j) {
                if (i + j + 2 <= n_) add(at(i, j), at(i + 1, j), at(i + 2, j));
                if (i + j + 2 <= n_) add(at(i, j), at(i, j + 1), at(i, j + 2));
                if (i + 2 <= n_ && j >= 2) add(at(i, j), at(i + 1, j - 1), at(i + 2, j - 2));
            }
        return largest;
    }

  private:
    int n_;
    std::vector<Eigen::Vector3d> points_;
};

/// Calls visit(i, j, point of the triangle, parameters) over the grid of a triangle.
template <typename Visit>
void over_grid(const FaceTriangle& t, int n, const Visit& visit)
{
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const Eigen::Vector3d barycentric = Eigen::Vector3d(n - i - j, i, j) / n;
            visit(i, j, Eigen::Vector3d(t.corners * barycentric), t.at(barycentric));
        }
}

/// Points of the surface for those of a triangle.
enum class Partner {
    parameters, ///< those with the same parameters: quick, and close where the surface is nearly flat
    foot        ///< the closest ones
};

/// Bound of the distances between the points of a triangle and their partners, by a grid of n intervals.
double bound_by_grid(const Adaptor3d_Surface& surface, const FaceTriangle& t, int n, Partner partner)
{
    TriangleGrid grid(n);
    double distance = 0;
    over_grid(t, n, [&](int i, int j, const Eigen::Vector3d& flat, const Eigen::Vector2d& uv) {
        grid.at(i, j) = partner == Partner::foot ? foot_on_surface(surface, uv, flat).point
                                                 : vector_of(surface.Value(uv.x(), uv.y()));
        distance = std::max(distance, (grid.at(i, j) - flat).norm());
    });
    return distance + grid.second_difference() / 6;
}

double bound_of(const Adaptor3d_Surface& surface, const FaceTriangle& t, double tolerance, Partner partner)
{
    double bound = std::numeric_limits<double>::infinity();
    for (int halvings = 1; halvings <= kMaxHalvings && bound > tolerance; ++halvings)
        bound = std::min(bound, bound_by_grid(surface, t, 1 << halvings, partner));
    return bound;
}

/// Bound of the distances between an edge and its chords.
double bound_of(const BRepAdaptor_Curve& curve, double t0, double t1, double tolerance)
{
    double bound = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d a = vector_of(curve.Value(t0)), b = vector_of(curve.Value(t1));
    const Eigen::Matrix3d chord = (Eigen::Matrix3d() << a, b, b).finished();
    for (int halvings = 1; halvings <= kMaxHalvings && bound > tolerance; ++halvings) {
        const int n = 1 << halvings;
        std::vector<Eigen::Vector3d> points;
        double distance = 0, bend = 0;
        for (int i = 0; i <= n; ++i) {
            points.push_back(vector_of(curve.Value(t0 + (t1 - t0) * i / n)));
            distance = std::max(distance, mesh::closest_on_triangle(chord, points.back()).squared_distance);
            if (i >= 2) bend = std::max(bend, (points[i] - 2 * points[i - 1] + points[i - 2]).norm());
        }
        bound = std::min(bound, std::sqrt(distance) + bend / 8);
    }
    return bound;
}

double edges_bound(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation,
                   const TopLoc_Location& location, double tolerance)
{
    double bound = 0;
    for (TopExp_Explorer explorer(face, TopAbs_EDGE); explorer.More(); explorer.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(explorer.Current());
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
        if (BRep_Tool::Degenerated(edge) || polygon.IsNull() || !polygon->HasParameters()) continue;
        const BRepAdaptor_Curve curve(edge);
        const TColStd_Array1OfReal& t = polygon->Parameters()->Array1();
        for (int i = t.Lower(); i < t.Upper(); ++i) bound = std::max(bound, bound_of(curve, t(i), t(i + 1), tolerance));
    }
    return bound;
}

std::vector<FaceTriangle> triangles_of(const Poly_Triangulation& triangulation, const gp_Trsf& placing,
                                       const BRepAdaptor_Surface& surface)
{
    std::vector<FaceTriangle> triangles(static_cast<std::size_t>(triangulation.NbTriangles()));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        FaceTriangle& t = triangles[i];
        for (int k = 0; k < 3; ++k) {
            const int node = triangulation.Triangle(static_cast<int>(i) + 1).Value(k + 1);
            const gp_Pnt2d uv = triangulation.UVNode(node);
            t.corners.col(k) = vector_of(triangulation.Node(node).Transformed(placing));
            t.uv.col(k) << uv.X(), uv.Y();
        }
        if (surface.GetType() != GeomAbs_Plane) find_singular_corners(surface, t);
    }
    return triangles;
}

} // namespace

double deviation_bound(const TopoDS_Face& face, double tolerance)
{
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    const BRepAdaptor_Surface surface(face, false);
    const std::vector<FaceTriangle> triangles = triangles_of(*triangulation, location.Transformation(), surface);
    const auto bound_with = [&](Partner partner) {
        double bound = 0;
        for (const FaceTriangle& t : triangles)
            if (bound = std::max(bound, bound_of(surface, t, tolerance, partner)); bound > tolerance) break;
        return bound;
    };
    double bound = bound_with(Partner::parameters);
    if (bound > tolerance) bound = bound_with(Partner::foot);
    return std::max(bound, edges_bound(face, triangulation, location, tolerance));
}

} // namespace fettle::cad
