#include "compare/winding.h"

#include <Eigen/Geometry>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace fettle {

namespace {

/// Facets that are joined, and by what: facets of one root form a piece; a facet with `turned` is wound the other way
/// than its parent. (Union-find with parities.)
class Pieces {
  public:
    struct Place {
        std::uint32_t root;
        bool turned; ///< against the root
    };

    explicit Pieces(std::size_t facets) : parent_(facets), turned_(facets, false)
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    Place place(std::uint32_t facet)
    {
        std::uint32_t root = facet;
        bool turned = false;
        for (; parent_[root] != root; root = parent_[root]) turned = turned != turned_[root];
        for (bool way = turned; parent_[facet] != root && facet != root;) { // the path becomes short
            const std::uint32_t next = parent_[facet];
            const bool step = turned_[facet];
            parent_[facet] = root;
            turned_[facet] = way;
            way = way != step;
            facet = next;
        }
        return {root, turned};
    }

    /// @param against  are the two wound against each other? What was joined before stays as it is.
    void join(std::uint32_t one, std::uint32_t other, bool against)
    {
        const Place a = place(one), b = place(other);
        if (a.root == b.root) return;
        const auto [low, high] = std::minmax(a.root, b.root);
        parent_[high] = low;
        turned_[high] = (a.turned != b.turned) != against;
    }

  private:
    std::vector<std::uint32_t> parent_;
    std::vector<bool> turned_;
};

struct Edge {
    int low, high;
    std::uint32_t facet;
    bool upward; ///< does the facet run from low to high?

    bool same(const Edge& other) const { return low == other.low && high == other.high; }
};

/// Puts the sides of one edge one after the other.
std::vector<Edge> sorted(std::vector<Edge> edges)
{
    tbb::parallel_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
    });
    return edges;
}

/// Adds the sides of a facet. @param chosen  of an edge's two ends
template <typename Chosen>
void add_edges(const Eigen::Matrix3Xi& facets, std::uint32_t facet, const Chosen& chosen, std::vector<Edge>& edges)
{
    for (int k = 0; k < 3; ++k) {
        const int a = facets(k, facet), b = facets((k + 1) % 3, facet);
        if (a != b && chosen(a, b)) edges.push_back({std::min(a, b), std::max(a, b), facet, a < b});
    }
}

/// Calls `use` with the first side of every edge and their number.
template <typename Use>
void for_each_edge(const std::vector<Edge>& edges, const Use& use)
{
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        for (end = i + 1; end < edges.size() && edges[end].same(edges[i]);) ++end;
        use(&edges[i], end - i);
    }
}

/// Do any two facets that share an edge run along it the same way? Then both of its ends are open.
bool any_disagree(const Eigen::Matrix3Xi& facets, const Gaps& gaps)
{
    const auto both = [&](int a, int b) {
        return gaps.open[static_cast<std::size_t>(a)] && gaps.open[static_cast<std::size_t>(b)];
    };
    std::vector<Edge> edges;
    for (const std::uint32_t facet : gaps.facets) add_edges(facets, facet, both, edges);
    bool disagree = false;
    for_each_edge(sorted(std::move(edges)), [&](const Edge* side, std::size_t count) {
        disagree |= count == 2 && side[0].upward == side[1].upward;
    });
    return disagree;
}

/// Joins facets over the edges that two of them share. @return  those that have another kind of edge
std::vector<std::uint32_t> join_over_edges(const Eigen::Matrix3Xi& facets, Pieces& pieces)
{
    std::vector<Edge> edges;
    edges.reserve(static_cast<std::size_t>(facets.size()));
    for (Eigen::Index t = 0; t < facets.cols(); ++t)
        add_edges(
            facets, static_cast<std::uint32_t>(t), [](int, int) { return true; }, edges);
    std::vector<std::uint32_t> at_border;
    for_each_edge(sorted(std::move(edges)), [&](const Edge* side, std::size_t count) {
        if (count == 2)
            pieces.join(side[0].facet, side[1].facet, side[0].upward == side[1].upward);
        else
            for (std::size_t i = 0; i < count; ++i) at_border.push_back(side[i].facet);
    });
    return at_border;
}

/// Joins facets at their vertices, all wound alike.
void join_over_vertices(const Eigen::Matrix3Xi& facets, Eigen::Index vertices, Pieces& pieces)
{
    constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> first(static_cast<std::size_t>(vertices), kNone);
    for (Eigen::Index t = 0; t < facets.cols(); ++t)
        for (const int v : facets.col(t)) {
            std::uint32_t& at = first[static_cast<std::size_t>(v)];
            if (at == kNone)
                at = static_cast<std::uint32_t>(t);
            else
                pieces.join(at, static_cast<std::uint32_t>(t), false);
        }
}

struct Piece {
    double area_turned = 0; ///< less that of those like the root, mm²
    double volume = 0;      ///< as the root is wound, mm³
    bool closed = true;
    Eigen::AlignedBox3d box;
};

} // namespace

std::vector<std::uint32_t> wrongly_wound(const Eigen::Matrix3Xd& vertices, const Eigen::Matrix3Xi& facets,
                                         const Gaps& gaps)
{
    const bool closed = std::find(gaps.open.begin(), gaps.open.end(), true) == gaps.open.end();
    if (!closed && !any_disagree(facets, gaps)) return {};
    Pieces pieces(static_cast<std::size_t>(facets.cols()));
    std::vector<std::uint32_t> at_border;
    if (closed)
        join_over_vertices(facets, vertices.cols(), pieces);
    else
        at_border = join_over_edges(facets, pieces);

    const Eigen::Vector3d middle =
        facets.cols() > 0 ? Eigen::Vector3d(vertices.col(facets(0, 0))) : Eigen::Vector3d::Zero();
    std::vector<Piece> of_root(static_cast<std::size_t>(facets.cols()));
    std::vector<std::uint32_t> roots;
    for (Eigen::Index t = 0; t < facets.cols(); ++t) {
        const auto [root, turned] = pieces.place(static_cast<std::uint32_t>(t));
        Piece& piece = of_root[root];
        if (piece.box.isEmpty()) roots.push_back(root);
        const Eigen::Vector3d p = vertices.col(facets(0, t)), q = vertices.col(facets(1, t)),
                              r = vertices.col(facets(2, t));
        const double area = (q - p).cross(r - p).norm() / 2;
        piece.area_turned += turned ? area : -area;
        piece.volume += (turned ? -1 : 1) * (p - middle).dot((q - middle).cross(r - middle)) / 6;
        for (const Eigen::Vector3d& corner : {p, q, r}) piece.box.extend(corner);
    }
    for (const std::uint32_t t : at_border) of_root[pieces.place(t).root].closed = false;
    const auto turn_root = [&](std::uint32_t root) {
        const Piece& piece = of_root[root];
        const bool most = piece.area_turned > 0;
        if (!piece.closed || (most ? -piece.volume : piece.volume) >= 0) return most;
        for (const std::uint32_t other : roots)
            if (other != root && of_root[other].closed && of_root[other].box.contains(piece.box)) return most;
        return !most;
    };
    std::vector<bool> turn(of_root.size());
    for (const std::uint32_t root : roots) turn[root] = turn_root(root);
    std::vector<std::uint32_t> wrong;
    for (Eigen::Index t = 0; t < facets.cols(); ++t) {
        const auto [root, turned] = pieces.place(static_cast<std::uint32_t>(t));
        if (turn[root] != turned) wrong.push_back(static_cast<std::uint32_t>(t));
    }
    return wrong;
}

} // namespace fettle
