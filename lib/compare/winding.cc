#include "compare/winding.h"

#include "geometry/union_find.h"

#include <Eigen/Geometry>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace fettle::compare {

namespace {

/// Components of facets that are connected; an odd facet is wound opposite to the root of its component.
using Components = geometry::UnionFind;

/// An edge as a side of one facet.
struct HalfEdge {
    int low, high;
    std::uint32_t facet;
    bool upward; ///< the facet runs from low to high

    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// Adds the half-edges of a facet whose two ends pass the filter.
template <typename Filter>
void add_half_edges(const Eigen::Matrix3Xi& facets, std::uint32_t facet, const Filter& filter,
                    std::vector<HalfEdge>& half_edges)
{
    for (int k = 0; k < 3; ++k) {
        const int a = facets(k, facet), b = facets((k + 1) % 3, facet);
        if (a != b && filter(a, b)) half_edges.push_back({std::min(a, b), std::max(a, b), facet, a < b});
    }
}

/// Sorts the half-edges and calls `use` for each edge with its first half-edge and their number.
template <typename Use>
void for_each_edge(std::vector<HalfEdge> half_edges, const Use& use)
{
    tbb::parallel_sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
    });
    for (std::size_t i = 0, end = 0; i < half_edges.size(); i = end) {
        for (end = i + 1; end < half_edges.size() && half_edges[end].same_edge(half_edges[i]);) ++end;
        use(&half_edges[i], end - i);
    }
}

/// Whether any two facets that share an edge run along it in the same direction: both of its ends are open then.
bool any_disagree(const Eigen::Matrix3Xi& facets, const OpenVertices& open_vertices)
{
    const auto both_open = [&](int a, int b) { return open_vertices.open[a] && open_vertices.open[b]; };
    std::vector<HalfEdge> half_edges;
    for (const std::uint32_t facet : open_vertices.facets) add_half_edges(facets, facet, both_open, half_edges);
    bool disagree = false;
    for_each_edge(std::move(half_edges), [&](const HalfEdge* half_edge, std::size_t count) {
        disagree |= count == 2 && half_edge[0].upward == half_edge[1].upward;
    });
    return disagree;
}

/// Joins facets across edges that exactly two of them share. @return  facets that have an edge of another kind
std::vector<std::uint32_t> join_across_edges(const Eigen::Matrix3Xi& facets, Components& components)
{
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(facets.size());
    const auto any = [](int, int) { return true; };
    for (std::uint32_t t = 0; t < facets.cols(); ++t) add_half_edges(facets, t, any, half_edges);
    std::vector<std::uint32_t> at_border;
    for_each_edge(std::move(half_edges), [&](const HalfEdge* half_edge, std::size_t count) {
        if (count == 2)
            components.join(half_edge[0].facet, half_edge[1].facet, half_edge[0].upward == half_edge[1].upward);
        else
            for (std::size_t i = 0; i < count; ++i) at_border.push_back(half_edge[i].facet);
    });
    return at_border;
}

/// Joins facets that share a vertex, all with the same winding.
void join_at_vertices(const Eigen::Matrix3Xi& facets, Eigen::Index vertices, Components& components)
{
    constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> first_facet(vertices, kNone);
    for (std::uint32_t t = 0; t < facets.cols(); ++t)
        for (const int v : facets.col(t)) {
            if (first_facet[v] == kNone) first_facet[v] = t;
            components.join(first_facet[v], t, false);
        }
}

struct Component {
    double flipped_area = 0; ///< area of the flipped facets minus that of the others, mm²
    double volume = 0;       ///< with the winding of the root, mm³
    bool closed = true;
    Eigen::AlignedBox3d box;
};

} // namespace

std::vector<std::uint32_t> facets_to_flip(const Eigen::Matrix3Xd& vertices, const Eigen::Matrix3Xi& facets,
                                          const OpenVertices& open_vertices)
{
    const bool closed = std::ranges::find(open_vertices.open, true) == open_vertices.open.end();
    if (!closed && !any_disagree(facets, open_vertices)) return {};
    Components components(facets.cols());
    std::vector<std::uint32_t> at_border;
    if (closed)
        join_at_vertices(facets, vertices.cols(), components);
    else
        at_border = join_across_edges(facets, components);

    const Eigen::Vector3d origin =
        facets.cols() > 0 ? Eigen::Vector3d(vertices.col(facets(0, 0))) : Eigen::Vector3d::Zero();
    std::vector<Component> of_root(facets.cols());
    std::vector<std::uint32_t> roots;
    for (std::uint32_t t = 0; t < facets.cols(); ++t) {
        const auto [root, flipped] = components.find(t);
        Component& component = of_root[root];
        if (component.box.isEmpty()) roots.push_back(root);
        const Eigen::Vector3d p = vertices.col(facets(0, t)), q = vertices.col(facets(1, t)),
                              r = vertices.col(facets(2, t));
        const double area = (q - p).cross(r - p).norm() / 2;
        component.flipped_area += flipped ? area : -area;
        component.volume += (flipped ? -1 : 1) * (p - origin).dot((q - origin).cross(r - origin)) / 6;
        for (const Eigen::Vector3d& corner : {p, q, r}) component.box.extend(corner);
    }
    for (const std::uint32_t t : at_border) of_root[components.root(t)].closed = false;
    const auto flip_root = [&](std::uint32_t root) {
        const Component& component = of_root[root];
        const bool majority_flipped = component.flipped_area > 0;
        const double volume = majority_flipped ? -component.volume : component.volume;
        if (!component.closed || volume >= 0) return majority_flipped;
        for (const std::uint32_t other : roots)
            if (other != root && of_root[other].closed && of_root[other].box.contains(component.box))
                return majority_flipped;
        return !majority_flipped;
    };
    std::vector<bool> flip(of_root.size());
    for (const std::uint32_t root : roots) flip[root] = flip_root(root);
    std::vector<std::uint32_t> wrong;
    for (std::uint32_t t = 0; t < facets.cols(); ++t) {
        const auto [root, flipped] = components.find(t);
        if (flip[root] != flipped) wrong.push_back(t);
    }
    return wrong;
}

} // namespace fettle::compare
