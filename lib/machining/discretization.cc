#include "machining/discretization.h"

#include "core/constants.h"
#include "core/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace fettle {
namespace {

constexpr double kSharp = 30 * kRadPerDegree;    // angle of an edge that is meant as one
constexpr double kSteepest = 80 * kRadPerDegree; // slope of a wall
constexpr double kLeftOut = 0.01;                // share of the area
/// An edge flatter than this is flat: the angle that the rounding of an STL's floats makes of a plane.
constexpr double kFlat = 1e-4;

/// A value and the area that it stands for.
using Weighted = std::pair<double, double>;

/// The greatest value but for a share of the whole area; 0 of nothing.
double greatest(std::vector<Weighted> values, double whole)
{
    std::sort(values.begin(), values.end(), std::greater<>());
    double area = 0;
    for (const auto& [value, weight] : values)
        if ((area += weight) > kLeftOut * whole) return value;
    return 0;
}

struct Edge {
    int a, b; ///< a < b
    int opposite;
    Eigen::Index triangle;
    auto key() const { return std::pair(a, b); }
};

/// Edges of the triangles that face up, those of one edge beside each other.
std::vector<Edge> edges_of(const Mesh& mesh, const Eigen::Matrix3Xd& normals)
{
    std::vector<Edge> edges;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        if (!(normals(2, t) > std::cos(kSteepest))) continue;
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles(k, t), b = mesh.triangles((k + 1) % 3, t);
            edges.push_back({std::min(a, b), std::max(a, b), mesh.triangles((k + 2) % 3, t), t});
        }
    }
    std::stable_sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) { return p.key() < q.key(); });
    return edges;
}

/// Curvature across the edge of two facets, + where it bulges, 1/mm: the angle of their normals over the distance of
/// the centres of their circles, |e| (cot α + cot β)/2 for the angles α, β over against the edge e. On a sphere these
/// centres are where the facets' normals are those of the sphere. 0: none to be had.
double curvature(const Mesh& mesh, const Eigen::Matrix3Xd& normals, const Edge& edge, const Edge& other)
{
    constexpr double kThin = 0.1; // of the facets' height over the edge: centres so near each other tell nothing
    const Eigen::Vector3d a = mesh.vertices.col(edge.a), b = mesh.vertices.col(edge.b);
    const double size = (b - a).norm();
    double across = 0, height = 0;
    for (const int opposite : {edge.opposite, other.opposite}) {
        const Eigen::Vector3d p = a - mesh.vertices.col(opposite), q = b - mesh.vertices.col(opposite);
        const double twice_area = p.cross(q).norm();
        across += p.dot(q) / twice_area * size / 2;
        height += twice_area / size / 2;
    }
    const Eigen::Vector3d m = normals.col(edge.triangle), n = normals.col(other.triangle);
    const double angle = std::atan2(m.cross(n).norm(), m.dot(n));
    if (!(std::abs(across) > kThin * height && angle > kFlat && angle < kSharp)) return 0;
    const bool falls_off = (mesh.vertices.col(edge.opposite) - a).dot(n) < 0;
    return (falls_off ? angle : -angle) / across;
}

/// e_s (eq. 1) and e_p (eq. 3) on the level.
double surface_error(double step, double radius)
{
    const double square = step * step / 2;
    return square < radius * radius ? square / (radius + std::sqrt(radius * radius - square)) : radius;
}
double sampling_error(double step, double radius) { return step * step / (3 * radius); }

/// The step at which e_s of a radius is e: eq. 2 without its approximation.
double step_for_surface(double e, double radius)
{
    if (std::isinf(radius)) return radius;
    const double most = std::min(e, radius); // no sphere stands off its middle by more
    return std::sqrt(2 * most * (2 * radius - most));
}

/// The step at which e_s + e_p is e. With u = R_x²: (R + u/(3 r) − e)² = R² − u/2.
double step_for_both(double e, double R, double r)
{
    if (std::isinf(R)) return std::sqrt(3 * e * r);
    const double most = std::min(e, R);
    const double a = 1 / (9 * r * r), b = 2 * (R - most) / (3 * r) + 0.5, c = -most * (2 * R - most);
    return std::sqrt(-2 * c / (b + std::sqrt(b * b - 4 * a * c)));
}

} // namespace

DesignShape shape_of(const Mesh& design)
{
    const Eigen::Matrix3Xd normals = triangle_normals(design);
    Eigen::VectorXd areas(normals.cols());
    double whole = 0;
    std::vector<Weighted> slopes, convex, concave;
    for (Eigen::Index t = 0; t < normals.cols(); ++t) {
        const Eigen::Vector3d a = design.vertices.col(design.triangles(0, t));
        const Eigen::Vector3d b = design.vertices.col(design.triangles(1, t));
        const Eigen::Vector3d c = design.vertices.col(design.triangles(2, t));
        areas[t] = (b - a).cross(c - a).norm() / 2;
        if (!(normals(2, t) > std::cos(kSteepest))) continue;
        whole += areas[t];
        slopes.emplace_back(std::acos(std::min(normals(2, t), 1.0)), areas[t]);
    }
    if (slopes.empty()) throw InputError("nothing of the design faces up");
    const std::vector<Edge> edges = edges_of(design, normals);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        if (edges[i].key() != edges[i + 1].key()) continue;
        const double bulge = curvature(design, normals, edges[i], edges[i + 1]);
        // of the three edges that a facet has each stands for a third of it
        const double area = (areas[edges[i].triangle] + areas[edges[i + 1].triangle]) / 3;
        if (bulge != 0) (bulge > 0 ? convex : concave).emplace_back(std::abs(bulge), area);
    }
    return {1 / greatest(convex, whole), 1 / greatest(concave, whole), greatest(slopes, whole)};
}

std::string to_string(ShapeKind kind)
{
    return kind == ShapeKind::convex ? "convex" : (kind == ShapeKind::concave ? "concave" : "mixed");
}

ShapeKind kind_of(const DesignShape& shape)
{
    if (std::isinf(shape.concave_radius)) return ShapeKind::convex;
    return std::isinf(shape.convex_radius) ? ShapeKind::concave : ShapeKind::mixed;
}

double sampling_radius(const Cutter& cutter) { return cutter.corner > 0 ? cutter.corner : cutter.radius; }

Spacing spacing_for(double tolerance, double radius, const DesignShape& shape, bool as_published)
{
    Spacing spacing;
    spacing.kind = kind_of(shape);
    const double R = std::min(shape.convex_radius, shape.concave_radius);
    const bool concave = spacing.kind == ShapeKind::concave;
    const double across = as_published ? 1 : 1 / std::cos(shape.slope), between = std::sqrt((1 + across * across) / 2);
    const double level = between / across; // what e_p grows by less than e_s
    if (as_published)
        spacing.step = concave ? std::min(2 * std::sqrt(R * tolerance), std::sqrt(3 * tolerance * radius))
                               : std::sqrt(tolerance / (1 / (4 * R) + 1 / (3 * radius)));
    else if (concave)
        spacing.step = std::min(step_for_surface(tolerance, R) / across, std::sqrt(3 * tolerance * radius) / between);
    else
        spacing.step = step_for_both(tolerance, R, radius / (level * level)) / across;
    spacing.surface_error = std::isinf(R) ? 0 : surface_error(across * spacing.step, R);
    spacing.sampling_error = sampling_error(between * spacing.step, radius);
    spacing.predicted_error = concave ? std::max(spacing.surface_error, spacing.sampling_error)
                                      : spacing.surface_error + spacing.sampling_error;
    return spacing;
}

json::Value to_json(const Spacing& spacing, const DesignShape& shape)
{
    return json::Value()
        .set("shape", to_string(spacing.kind))
        .set("convex_radius", shape.convex_radius)
        .set("concave_radius", shape.concave_radius)
        .set("slope_deg", shape.slope / kRadPerDegree)
        .set("surface_error", spacing.surface_error)
        .set("sampling_error", spacing.sampling_error)
        .set("predicted_error", spacing.predicted_error);
}

} // namespace fettle
