#include "machining/discretization.h"

#include "core/constants.h"
#include "core/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace fettle::machining {
namespace {

constexpr double kSharpEdgeAngle = 30 * core::kRadPerDegree;
constexpr double kMaxSlope = 80 * core::kRadPerDegree; // steeper facets are walls
constexpr double kIgnoredAreaFraction = 0.01;
/// Edges with a smaller angle are flat, rad: rounding to float in an STL gives the facets of a plane such angles.
constexpr double kMinEdgeAngle = 1e-4;

/// A value and its weight, an area.
using Weighted = std::pair<double, double>;

/// Upper quantile by area: the value above which lies the fraction kIgnoredAreaFraction; 0 if there are no values.
double upper_quantile(std::vector<Weighted> values, double total_area)
{
    std::ranges::sort(values, std::greater<>());
    double area = 0;
    for (const auto& [value, weight] : values)
        if ((area += weight) > kIgnoredAreaFraction * total_area) return value;
    return 0;
}

struct Edge {
    int a, b; ///< a < b
    int opposite;
    Eigen::Index triangle;
    auto key() const { return std::pair(a, b); } ///< equal for the same edge of another triangle
};

/// Edges of the triangles that face up, sorted so that equal edges are neighbours.
std::vector<Edge> edges_of(const mesh::Mesh& mesh, const Eigen::Matrix3Xd& normals)
{
    std::vector<Edge> edges;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        if (!(normals(2, t) > std::cos(kMaxSlope))) continue;
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles(k, t), b = mesh.triangles((k + 1) % 3, t);
            edges.push_back({std::min(a, b), std::max(a, b), mesh.triangles((k + 2) % 3, t), t});
        }
    }
    std::ranges::stable_sort(edges, {}, &Edge::key);
    return edges;
}

/// Curvature across the edge of two facets, positive if convex, 1/mm: the angle of their normals over the distance of
/// their circumcentres, |e| (cot α + cot β)/2 for the angles α, β opposite to the edge e. On a sphere the normal of a
/// facet is that of the sphere at the circumcentre. 0: no estimate.
double curvature(const mesh::Mesh& mesh, const Eigen::Matrix3Xd& normals, const Edge& edge, const Edge& other)
{
    constexpr double kMinCentreDistance = 0.1; // as a fraction of the facets' heights; below it noise dominates
    const Eigen::Vector3d a = mesh.vertices.col(edge.a), b = mesh.vertices.col(edge.b);
    const double edge_length = (b - a).norm();
    double across = 0, height = 0;
    for (const int opposite : {edge.opposite, other.opposite}) {
        const Eigen::Vector3d p = a - mesh.vertices.col(opposite), q = b - mesh.vertices.col(opposite);
        const double twice_area = p.cross(q).norm();
        across += p.dot(q) / twice_area * edge_length / 2;
        height += twice_area / edge_length / 2;
    }
    const Eigen::Vector3d m = normals.col(edge.triangle), n = normals.col(other.triangle);
    const double angle = std::atan2(m.cross(n).norm(), m.dot(n));
    if (!(std::abs(across) > kMinCentreDistance * height && angle > kMinEdgeAngle && angle < kSharpEdgeAngle)) return 0;
    const bool convex = (mesh.vertices.col(edge.opposite) - a).dot(n) < 0;
    return (convex ? angle : -angle) / across;
}

/// e_s (eq. 1) on a horizontal surface.
double surface_error(double step, double radius)
{
    const double square = step * step / 2;
    return square < radius * radius ? square / (radius + std::sqrt(radius * radius - square)) : radius;
}

/// e_p (eq. 3) on a horizontal surface.
double sampling_error(double step, double radius) { return step * step / (3 * radius); }

/// The step at which e_s of a radius is e: eq. 2 without its approximation.
double step_for_surface(double e, double radius)
{
    if (std::isinf(radius)) return radius;
    const double sag = std::min(e, radius); // a chord of a sphere has no larger sag
    return std::sqrt(2 * sag * (2 * radius - sag));
}

/// The step at which e_s + e_p is e. With u = R_x²: (R + u/(3 r) − e)² = R² − u/2.
double step_for_both(double e, double R, double r)
{
    if (std::isinf(R)) return std::sqrt(3 * e * r);
    const double sag = std::min(e, R);
    const double a = 1 / (9 * r * r), b = 2 * (R - sag) / (3 * r) + 0.5, c = -sag * (2 * R - sag);
    return std::sqrt(-2 * c / (b + std::sqrt(b * b - 4 * a * c)));
}

} // namespace

DesignShape estimate_design_shape(const mesh::Mesh& design)
{
    const Eigen::Matrix3Xd normals = mesh::triangle_normals(design);
    Eigen::VectorXd areas(normals.cols());
    double total_area = 0;
    std::vector<Weighted> slopes, convex, concave;
    for (Eigen::Index t = 0; t < normals.cols(); ++t) {
        const mesh::Triangle p = mesh::triangle_of(design, t);
        areas[t] = (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm() / 2;
        if (!(normals(2, t) > std::cos(kMaxSlope))) continue;
        total_area += areas[t];
        slopes.emplace_back(std::acos(std::min(normals(2, t), 1.0)), areas[t]);
    }
    if (slopes.empty()) throw core::InputError("no facet of the design faces up");
    const std::vector<Edge> edges = edges_of(design, normals);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        if (edges[i].key() != edges[i + 1].key()) continue;
        const double kappa = curvature(design, normals, edges[i], edges[i + 1]);
        // Each of the three edges of a facet has a third of its area.
        const double area = (areas[edges[i].triangle] + areas[edges[i + 1].triangle]) / 3;
        if (kappa != 0) (kappa > 0 ? convex : concave).emplace_back(std::abs(kappa), area);
    }
    return {1 / upper_quantile(convex, total_area), 1 / upper_quantile(concave, total_area),
            upper_quantile(slopes, total_area)};
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
    const double ratio = between / across; // growth of e_p relative to that of e_s
    if (as_published)
        spacing.step = concave ? std::min(2 * std::sqrt(R * tolerance), std::sqrt(3 * tolerance * radius))
                               : std::sqrt(tolerance / (1 / (4 * R) + 1 / (3 * radius)));
    else if (concave)
        spacing.step = std::min(step_for_surface(tolerance, R) / across, std::sqrt(3 * tolerance * radius) / between);
    else
        spacing.step = step_for_both(tolerance, R, radius / (ratio * ratio)) / across;
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
        .set("slope_deg", shape.slope / core::kRadPerDegree)
        .set("surface_error", spacing.surface_error)
        .set("sampling_error", spacing.sampling_error)
        .set("predicted_error", spacing.predicted_error);
}

} // namespace fettle::machining
