#include "compare/pseudo_normals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle::compare {

/// The feature of the mesh that a foot lies on, from its zero barycentric coordinates.
struct PseudoNormals::Feature {
    enum { facet, edge, vertex } kind;
    Vertex a = 0, b = 0; ///< ends of the edge in the order of the facet, or the vertex a
};

PseudoNormals::PseudoNormals(const ReferenceMesh& mesh) : reference_(mesh), facets_(mesh.facets())
{
    first_.assign(mesh.mesh.vertices.cols() + 1, 0);
    for (const int v : facets_.reshaped()) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    vertex_facets_.resize(facets_.size());
    // Counting sort: each start advances to the start of the next vertex while the entries are filled in.
    for (Eigen::Index t = 0; t < facets_.cols(); ++t)
        for (const int v : facets_.col(t)) vertex_facets_[first_[v]++] = t;
    std::shift_right(first_.begin(), first_.end(), 1);
    first_.front() = 0;
}

std::span<const std::uint32_t> PseudoNormals::facets_at(Vertex v) const
{
    return {vertex_facets_.data() + first_[v], vertex_facets_.data() + first_[v + 1]};
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
    for (int i = 0; i < 3; ++i)
        if (weight[(i + 1) % 3] == 0 && weight[(i + 2) % 3] == 0) return {Feature::vertex, corners[i], corners[i]};
    for (int i = 0; i < 3; ++i) {
        const Vertex a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
        if (weight[i] == 0) return {a == b ? Feature::vertex : Feature::edge, a, b};
    }
    return {Feature::facet, 0, 0};
}

std::vector<Eigen::Index> PseudoNormals::facets_at_edge(Vertex a, Vertex b) const
{
    std::vector<Eigen::Index> found;
    for (const Eigen::Index t : facets_at(a))
        if ((facets_.col(t).array() == b).any() && (found.empty() || found.back() != t)) found.push_back(t);
    return found;
}

bool PseudoNormals::on_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const
{
    const Eigen::Vector3d edge = position(b) - position(a);
    const double along = std::clamp(edge.dot(point - position(a)) / edge.squaredNorm(), 0.0, 1.0);
    return (position(a) + along * edge - point).norm() <= reference_.rounding_at(point);
}

// Adds the normals of the facets at an edge. A degenerate facet is replaced by those across its other edges at the
// point.
void PseudoNormals::add_edge_normals(Vertex a, Vertex b, const Eigen::Vector3d& point, double weight,
                                     std::vector<Eigen::Index>& visited, Eigen::Vector3d& sum) const
{
    for (const Eigen::Index t : facets_at_edge(a, b)) {
        if (std::find(visited.begin(), visited.end(), t) != visited.end()) continue;
        visited.push_back(t);
        const Eigen::Vector3d normal = facet_normal(t);
        sum += weight * normal;
        if (!normal.isZero(0)) continue;
        for (int i = 0; i < 3; ++i) {
            const Vertex c = facets_(i, t), d = facets_((i + 1) % 3, t);
            if (c != d && on_edge(c, d, point)) add_edge_normals(c, d, point, weight, visited, sum);
        }
    }
}

// The vertex at `point` in the interior of an edge: the third corner of a degenerate facet that lies along the edge.
std::optional<PseudoNormals::Vertex> PseudoNormals::vertex_within_edge(Vertex a, Vertex b,
                                                                       const Eigen::Vector3d& point) const
{
    for (const Eigen::Index t : facets_at_edge(a, b)) {
        if (!facet_normal(t).isZero(0)) continue;
        for (const Vertex v : facets_.col(t))
            if (v != a && v != b && (position(v) - point).norm() <= reference_.rounding_at(point)) return v;
    }
    return std::nullopt;
}

Eigen::Vector3d PseudoNormals::vertex_normal(Vertex v) const
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Index> visited;
    const Eigen::Vector3d here = position(v);
    for (const Eigen::Index t : facets_at(v)) {
        if (std::find(visited.begin(), visited.end(), t) != visited.end()) continue;
        visited.push_back(t);
        const int corner = facets_(0, t) == v ? 0 : facets_(1, t) == v ? 1 : 2;
        const Vertex b = facets_((corner + 1) % 3, t), c = facets_((corner + 2) % 3, t);
        const Eigen::Vector3d normal = facet_normal(t);
        if (normal.isZero(0)) { // the vertex lies within a side of the facet across the far edge: its angle is π
            if (b != v && c != v && b != c && on_edge(b, c, here))
                add_edge_normals(b, c, here, std::numbers::pi, visited, sum);
            continue;
        }
        const Eigen::Vector3d to_b = position(b) - here, to_c = position(c) - here;
        sum += std::atan2(to_b.cross(to_c).norm(), to_b.dot(to_c)) * normal;
    }
    return sum;
}

Eigen::Vector3d PseudoNormals::normal(const mesh::MeshIndex::Closest& foot) const
{
    const Feature on = feature_at(foot);
    if (on.kind == Feature::facet)
        if (const Eigen::Vector3d normal = facet_normal(foot.triangle); !normal.isZero(0)) return normal;
    if (on.kind == Feature::vertex) return vertex_normal(on.a).normalized();
    if (on.kind == Feature::edge)
        if (const std::optional<Vertex> v = vertex_within_edge(on.a, on.b, foot.point))
            return vertex_normal(*v).normalized();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Index> visited;
    if (on.kind == Feature::edge) add_edge_normals(on.a, on.b, foot.point, 1, visited, sum);
    const Eigen::Vector3i corners = facets_.col(foot.triangle);
    if (on.kind == Feature::facet) // a degenerate facet: its neighbours decide
        for (int i = 0; i < 3; ++i)
            if (on_edge(corners[i], corners[(i + 1) % 3], foot.point))
                add_edge_normals(corners[i], corners[(i + 1) % 3], foot.point, 1, visited, sum);
    return sum.normalized();
}

double PseudoNormals::beyond_border(const mesh::MeshIndex::Closest& foot, const Eigen::Vector3d& offset) const
{
    const Feature on = feature_at(foot);
    if (on.kind == Feature::facet) return 0;
    double beyond = 0;
    const auto include_edge = [&](Vertex a, Vertex b) { // counter-clockwise in its facet: outward is to its right
        const std::vector<Eigen::Index> facets = facets_at_edge(a, b);
        if (facets.size() != 1) return;
        const Eigen::Vector3d outward = (position(b) - position(a)).cross(facet_normal(facets[0]));
        if (!outward.isZero(0)) beyond = std::max(beyond, offset.dot(outward.normalized()));
    };
    if (on.kind == Feature::edge) {
        include_edge(on.a, on.b);
        return beyond;
    }
    for (const Eigen::Index t : facets_at(on.a)) {
        const Eigen::Vector3i corners = facets_.col(t);
        for (int k = 0; k < 3; ++k)
            if (corners[k] == on.a || corners[(k + 1) % 3] == on.a) include_edge(corners[k], corners[(k + 1) % 3]);
    }
    return beyond;
}

} // namespace fettle::compare
