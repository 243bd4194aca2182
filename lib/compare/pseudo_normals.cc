#include "compare/pseudo_normals.h"

#include "compare/weld.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle {

/// What the foot lies on, by its zero barycentric coordinates.
struct PseudoNormals::Feature {
    enum { facet, edge, vertex } kind;
    Vertex a = 0, b = 0; ///< of the edge, in the order of the facet; a of the vertex
};

PseudoNormals::PseudoNormals(const Mesh& mesh) : mesh_(mesh), size_(typical_coordinate(mesh.vertices))
{
    const std::vector<Vertex> welded = weld(mesh.vertices, [this](const Eigen::Vector3d& v) { return rounding(v); });
    facets_ = mesh.triangles.unaryExpr([&](int v) { return welded[static_cast<std::size_t>(v)]; });
    normals_.resize(3, facets_.cols());
    tbb::parallel_for(Eigen::Index{0}, facets_.cols(), [&](Eigen::Index t) {
        const Eigen::Vector3d p = position(facets_(0, t)), q = position(facets_(1, t)), r = position(facets_(2, t));
        const Eigen::Vector3d twice_area = (q - p).cross(r - p);
        const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
        normals_.col(t).setZero();
        if (twice_area.norm() > rounding(p) * longest) normals_.col(t) = twice_area.normalized();
    });

    first_.assign(static_cast<std::size_t>(mesh.vertices.cols()) + 1, 0);
    for (const int v : facets_.reshaped()) ++first_[static_cast<std::size_t>(v) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    at_vertex_.resize(static_cast<std::size_t>(facets_.size()));
    std::vector<Eigen::Index> next(first_.begin(), first_.end() - 1);
    for (Eigen::Index t = 0; t < facets_.cols(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            at_vertex_[static_cast<std::size_t>(next[static_cast<std::size_t>(facets_(corner, t))]++)] = t;
}

double PseudoNormals::rounding(const Eigen::Vector3d& place) const
{
    return float_rounding(std::max(size_, place.cwiseAbs().maxCoeff()));
}

PseudoNormals::Feature PseudoNormals::feature(const MeshIndex::Closest& foot) const
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
    for (Eigen::Index i = first_[static_cast<std::size_t>(a)]; i < first_[static_cast<std::size_t>(a) + 1]; ++i) {
        const Eigen::Index t = at_vertex_[static_cast<std::size_t>(i)];
        if ((facets_.col(t).array() == b).any() && (found.empty() || found.back() != t)) found.push_back(t);
    }
    return found;
}

bool PseudoNormals::on_edge(Vertex a, Vertex b, const Eigen::Vector3d& point) const
{
    const Eigen::Vector3d edge = position(b) - position(a);
    const double along = std::clamp(edge.dot(point - position(a)) / edge.squaredNorm(), 0.0, 1.0);
    return (position(a) + along * edge - point).norm() <= rounding(point);
}

// Adds the normals of the facets at an edge; of one without a direction, those beyond its other edges at the point.
void PseudoNormals::add_beyond_edge(Vertex a, Vertex b, const Eigen::Vector3d& point, double weight,
                                    std::vector<Eigen::Index>& seen, Eigen::Vector3d& sum) const
{
    for (const Eigen::Index t : facets_at_edge(a, b)) {
        if (std::find(seen.begin(), seen.end(), t) != seen.end()) continue;
        seen.push_back(t);
        sum += weight * normals_.col(t);
        if (!normals_.col(t).isZero(0)) continue;
        for (int i = 0; i < 3; ++i) {
            const Vertex c = facets_(i, t), d = facets_((i + 1) % 3, t);
            if (c != d && on_edge(c, d, point)) add_beyond_edge(c, d, point, weight, seen, sum);
        }
    }
}

// The vertex at `point` amid an edge, of a facet without area that lies along the edge.
std::optional<PseudoNormals::Vertex> PseudoNormals::vertex_amid(Vertex a, Vertex b, const Eigen::Vector3d& point) const
{
    for (const Eigen::Index t : facets_at_edge(a, b)) {
        if (!normals_.col(t).isZero(0)) continue;
        for (const Vertex v : facets_.col(t))
            if (v != a && v != b && (position(v) - point).norm() <= rounding(point)) return v;
    }
    return std::nullopt;
}

Eigen::Vector3d PseudoNormals::vertex_normal(Vertex v) const
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Index> seen;
    const Eigen::Vector3d here = position(v);
    for (Eigen::Index i = first_[static_cast<std::size_t>(v)]; i < first_[static_cast<std::size_t>(v) + 1]; ++i) {
        const Eigen::Index t = at_vertex_[static_cast<std::size_t>(i)];
        if (std::find(seen.begin(), seen.end(), t) != seen.end()) continue;
        seen.push_back(t);
        const int corner = facets_(0, t) == v ? 0 : facets_(1, t) == v ? 1 : 2;
        const Vertex b = facets_((corner + 1) % 3, t), c = facets_((corner + 2) % 3, t);
        if (normals_.col(t).isZero(0)) { // the facet beyond its far edge has the vertex amid a side: half a turn
            if (b != v && c != v && b != c && on_edge(b, c, here))
                add_beyond_edge(b, c, here, std::numbers::pi, seen, sum);
            continue;
        }
        const Eigen::Vector3d to_b = position(b) - here, to_c = position(c) - here;
        sum += std::atan2(to_b.cross(to_c).norm(), to_b.dot(to_c)) * normals_.col(t);
    }
    return sum;
}

Eigen::Vector3d PseudoNormals::normal(const MeshIndex::Closest& foot) const
{
    const Feature on = feature(foot);
    if (on.kind == Feature::facet && !normals_.col(foot.triangle).isZero(0)) return normals_.col(foot.triangle);
    if (on.kind == Feature::vertex) return vertex_normal(on.a).normalized();
    if (on.kind == Feature::edge)
        if (const std::optional<Vertex> amid = vertex_amid(on.a, on.b, foot.point))
            return vertex_normal(*amid).normalized();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Index> seen;
    if (on.kind == Feature::edge) add_beyond_edge(on.a, on.b, foot.point, 1, seen, sum);
    const Eigen::Vector3i corners = facets_.col(foot.triangle);
    if (on.kind == Feature::facet) // a needle: look through it on either side
        for (int i = 0; i < 3; ++i)
            if (on_edge(corners[i], corners[(i + 1) % 3], foot.point))
                add_beyond_edge(corners[i], corners[(i + 1) % 3], foot.point, 1, seen, sum);
    return sum.normalized();
}

double PseudoNormals::beyond_border(const MeshIndex::Closest& foot, const Eigen::Vector3d& offset) const
{
    const Feature on = feature(foot);
    if (on.kind == Feature::facet) return 0;
    double beyond = 0;
    const auto look = [&](Vertex a, Vertex b) { // an edge of one facet, in that facet's order: outward is right of it
        const std::vector<Eigen::Index> facets = facets_at_edge(a, b);
        if (facets.size() != 1) return;
        const Eigen::Vector3d outward = (position(b) - position(a)).cross(Eigen::Vector3d(normals_.col(facets[0])));
        if (!outward.isZero(0)) beyond = std::max(beyond, offset.dot(outward.normalized()));
    };
    if (on.kind == Feature::edge) {
        look(on.a, on.b);
        return beyond;
    }
    for (Eigen::Index i = first_[static_cast<std::size_t>(on.a)]; i < first_[static_cast<std::size_t>(on.a) + 1]; ++i) {
        const Eigen::Vector3i corners = facets_.col(at_vertex_[static_cast<std::size_t>(i)]);
        for (int k = 0; k < 3; ++k)
            if (corners[k] == on.a || corners[(k + 1) % 3] == on.a) look(corners[k], corners[(k + 1) % 3]);
    }
    return beyond;
}

} // namespace fettle
