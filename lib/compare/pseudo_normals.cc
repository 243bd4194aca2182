#include "compare/pseudo_normals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::compare {

/// The feature of the mesh that a foot lies on, from its zero barycentric coordinates.
struct PseudoNormals::Feature {
    enum { facet, edge, vertex } kind;
    Vertex a = 0, b = 0; ///< ends of the edge in the order of the facet, or the vertex a
    Facets facets = {};  ///< at the edge or vertex
};

PseudoNormals::PseudoNormals(const ReferenceMesh& mesh, const mesh::MeshIndex& index)
    : reference_(mesh), index_(index), facets_(mesh.facets())
{
}

PseudoNormals::Facets PseudoNormals::facets_at(Vertex v) const
{
    Facets found = index_.nearby(position(v), reference_.max_weld_distance);
    std::erase_if(found, [&](std::uint32_t t) { return !has(t, v); });
    return found;
}

PseudoNormals::Facets PseudoNormals::facets_at_edge(Vertex a, Vertex b) const
{
    Facets found = facets_at(a);
    std::erase_if(found, [&](std::uint32_t t) { return !has(t, b); });
    return found;
}

Eigen::Vector3d PseudoNormals::facet_normal(Eigen::Index t) const
{
    const Eigen::Vector3d p = position(facets_(0, t)), q = position(facets_(1, t)), r = position(facets_(2, t));
    const Eigen::Vector3d twice_area = (q - p).cross(r - p);
    const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
    if (!(twice_area.norm() > reference_.rounding_at(p) * longest)) return Eigen::Vector3d::Zero();
    return twice_area.normalized();
}

PseudoNormals::Feature PseudoNormals::feature_at(const mesh::MeshIndex::Closest& foot) const
{
    const Eigen::Vector3i corners = facets_.col(foot.triangle);
    const Eigen::Vector3d& weight = foot.barycentric;
    const auto vertex = [&](Vertex v) { return Feature{Feature::vertex, v, v, facets_at(v)}; };
    for (int i = 0; i < 3; ++i)
        if (weight[(i + 1) % 3] == 0 && weight[(i + 2) % 3] == 0) return vertex(corners[i]);
    for (int i = 0; i < 3; ++i) {
        const Vertex a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
        if (weight[i] == 0) return a == b ? vertex(a) : Feature{Feature::edge, a, b, facets_at_edge(a, b)};
    }
    return {Feature::facet};
}

bool PseudoNormals::on_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const
{
    const Eigen::Vector3d edge = position(b) - position(a);
    const double along = std::clamp(edge.dot(point - position(a)) / edge.squaredNorm(), 0.0, 1.0);
    return (position(a) + along * edge - point).norm() <= reference_.rounding_at(point);
}

// Adds the normals of the facets at an edge. A degenerate facet is replaced by those across its other edges at the
// point.
void PseudoNormals::add_edge_normals(const Facets& at_edge, const Eigen::Vector3d& point, double weight,
                                     Facets& visited, Eigen::Vector3d& sum) const
{
    for (const std::uint32_t t : at_edge) {
        if (std::ranges::find(visited, t) != visited.end()) continue;
        visited.push_back(t);
        const Eigen::Vector3d normal = facet_normal(t);
        sum += weight * normal;
        if (!normal.isZero(0)) continue;
        for (int i = 0; i < 3; ++i) {
            const Vertex c = facets_(i, t), d = facets_((i + 1) % 3, t);
            if (c != d && on_edge(c, d, point)) add_edge_normals(facets_at_edge(c, d), point, weight, visited, sum);
        }
    }
}

// The vertex at `point` in the interior of an edge: the third corner of a degenerate facet that lies along the edge.
std::optional<PseudoNormals::Vertex> PseudoNormals::vertex_within_edge(const Feature& edge,
                                                                       const Eigen::Vector3d& point) const
{
    for (const std::uint32_t t : edge.facets) {
        if (!facet_normal(t).isZero(0)) continue;
        for (const Vertex v : facets_.col(t))
            if (v != edge.a && v != edge.b && (position(v) - point).norm() <= reference_.rounding_at(point)) return v;
    }
    return std::nullopt;
}

Eigen::Vector3d PseudoNormals::vertex_normal(Vertex v, const Facets& at_vertex) const
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Facets visited;
    const Eigen::Vector3d here = position(v);
    for (const std::uint32_t t : at_vertex) {
        if (std::ranges::find(visited, t) != visited.end()) continue;
        visited.push_back(t);
        const int corner = facets_(0, t) == v ? 0 : facets_(1, t) == v ? 1 : 2;
        const Vertex b = facets_((corner + 1) % 3, t), c = facets_((corner + 2) % 3, t);
        const Eigen::Vector3d normal = facet_normal(t);
        if (normal.isZero(0)) { // the vertex lies within a side of the facet across the far edge: its angle is π
            if (b != v && c != v && b != c && on_edge(b, c, here))
                add_edge_normals(facets_at_edge(b, c), here, std::numbers::pi, visited, sum);
            continue;
        }
        const Eigen::Vector3d to_b = position(b) - here, to_c = position(c) - here;
        sum += std::atan2(to_b.cross(to_c).norm(), to_b.dot(to_c)) * normal;
    }
    return sum.normalized();
}

Eigen::Vector3d PseudoNormals::normal(const mesh::MeshIndex::Closest& foot, const Feature& on) const
{
    if (on.kind == Feature::facet)
        if (const Eigen::Vector3d normal = facet_normal(foot.triangle); !normal.isZero(0)) return normal;
    if (on.kind == Feature::vertex) return vertex_normal(on.a, on.facets);
    if (on.kind == Feature::edge)
        if (const std::optional<Vertex> v = vertex_within_edge(on, foot.point)) return vertex_normal(*v, facets_at(*v));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Facets visited;
    if (on.kind == Feature::edge) add_edge_normals(on.facets, foot.point, 1, visited, sum);
    const Eigen::Vector3i corners = facets_.col(foot.triangle);
    if (on.kind == Feature::facet) // a degenerate facet: its neighbours decide
        for (int i = 0; i < 3; ++i)
            if (on_edge(corners[i], corners[(i + 1) % 3], foot.point))
                add_edge_normals(facets_at_edge(corners[i], corners[(i + 1) % 3]), foot.point, 1, visited, sum);
    return sum.normalized();
}

double PseudoNormals::beyond_border(const Feature& on, const Eigen::Vector3d& offset) const
{
    double beyond = 0;
    const auto include_edge = [&](Vertex a, Vertex b, const Facets& at_edge) {
        if (at_edge.size() != 1) return;
        // Counter-clockwise in its facet: outward is to its right.
        const Eigen::Vector3d outward = (position(b) - position(a)).cross(facet_normal(at_edge[0]));
        if (!outward.isZero(0)) beyond = std::max(beyond, offset.dot(outward.normalized()));
    };
    if (on.kind == Feature::edge) include_edge(on.a, on.b, on.facets);
    if (on.kind != Feature::vertex) return beyond;
    for (const std::uint32_t t : on.facets) {
        const Eigen::Vector3i corners = facets_.col(t);
        for (int k = 0; k < 3; ++k) {
            const Vertex a = corners[k], b = corners[(k + 1) % 3];
            if (a != on.a && b != on.a) continue;
            Facets at_edge = on.facets;
            std::erase_if(at_edge, [&](std::uint32_t other) { return !has(other, a == on.a ? b : a); });
            include_edge(a, b, at_edge);
        }
    }
    return beyond;
}

PseudoNormals::Side PseudoNormals::side(const mesh::MeshIndex::Closest& foot, const Eigen::Vector3d& offset) const
{
    const Feature on = feature_at(foot);
    return {normal(foot, on), beyond_border(on, offset)};
}

} // namespace fettle::compare
