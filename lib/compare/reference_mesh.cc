#include "compare/reference_mesh.h"

#include "compare/weld.h"
#include "compare/winding.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <utility>

namespace fettle {

namespace {

// Spreads the bits of a vertex's number (the finalizer of SplitMix64, Steele, Lea & Flood 2014).
std::uint64_t mixed(int vertex)
{
    std::uint64_t z = (static_cast<std::uint64_t>(vertex) + 1) * 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

/// Of each vertex: is there an edge at it that not as many facets run along one way as the other? Ways out of the
/// vertex add the other end's mixed number to its sum, ways into it take it off: what is left over is no zero, but
/// for one chance in 2^64.
std::vector<bool> open_vertices(const Eigen::Matrix3Xi& facets, Eigen::Index vertices)
{
    std::vector<std::uint64_t> sum(static_cast<std::size_t>(vertices), 0);
    for (const auto& facet : facets.colwise()) {
        const std::uint64_t a = mixed(facet[0]), b = mixed(facet[1]), c = mixed(facet[2]);
        sum[static_cast<std::size_t>(facet[0])] += b - c;
        sum[static_cast<std::size_t>(facet[1])] += c - a;
        sum[static_cast<std::size_t>(facet[2])] += a - b;
    }
    std::vector<bool> open(sum.size());
    for (std::size_t v = 0; v < sum.size(); ++v) open[v] = sum[v] != 0;
    return open;
}

int open_corners(const Gaps& gaps, const Eigen::Vector3i& facet)
{
    int count = 0;
    for (const int v : facet) count += gaps.open[static_cast<std::size_t>(v)];
    return count;
}

Gaps gaps_of(const ReferenceMesh& reference)
{
    const Eigen::Matrix3Xi& facets = reference.facets();
    Gaps gaps{open_vertices(facets, reference.mesh.vertices.cols()), {}};
    constexpr Eigen::Index kPiece = 1 << 16;
    std::vector<std::vector<std::uint32_t>> pieces(static_cast<std::size_t>((facets.cols() + kPiece - 1) / kPiece));
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        const Eigen::Index first = static_cast<Eigen::Index>(p) * kPiece;
        for (Eigen::Index t = first; t < std::min(first + kPiece, facets.cols()); ++t)
            if (open_corners(gaps, facets.col(t)) >= 2) pieces[p].push_back(static_cast<std::uint32_t>(t));
    });
    for (const auto& piece : pieces) gaps.facets.insert(gaps.facets.end(), piece.begin(), piece.end());
    return gaps;
}

void weld_open(ReferenceMesh& reference, const std::vector<bool>& open)
{
    std::vector<std::int32_t> candidates;
    for (std::size_t v = 0; v < open.size(); ++v)
        if (open[v] && reference.mesh.vertices.col(static_cast<Eigen::Index>(v)).allFinite())
            candidates.push_back(static_cast<std::int32_t>(v));
    const std::vector<std::int32_t> lowest =
        weld(reference.mesh.vertices, candidates, [&](const Eigen::Vector3d& v) { return reference.rounding(v); });
    for (std::size_t c = 0; c < lowest.size(); ++c) reference.repair.welded_vertices += lowest[c] != candidates[c];
    if (reference.repair.welded_vertices == 0) return;
    std::vector<std::int32_t> to(open.size());
    for (std::size_t v = 0; v < to.size(); ++v) to[v] = static_cast<std::int32_t>(v);
    for (std::size_t c = 0; c < lowest.size(); ++c) to[static_cast<std::size_t>(candidates[c])] = lowest[c];
    reference.welded = reference.mesh.triangles.unaryExpr([&](int v) { return to[static_cast<std::size_t>(v)]; });
}

/// Leaves out facets that have the corners of an earlier one and face the same way: thousands of them would each be
/// looked at for every point. All corners of such a facet are open.
void drop_repeated(ReferenceMesh& reference, const Gaps& gaps)
{
    using Corners = std::array<int, 3>;
    std::vector<std::pair<Corners, std::uint32_t>> order;
    for (const std::uint32_t t : gaps.facets) {
        const Eigen::Vector3i f = reference.facets().col(t); // begun at any corner it is the same
        if (open_corners(gaps, f) < 3) continue;
        order.emplace_back(std::min({Corners{f[0], f[1], f[2]}, Corners{f[1], f[2], f[0]}, Corners{f[2], f[0], f[1]}}),
                           t);
    }
    std::sort(order.begin(), order.end());
    std::vector<bool> repeated(static_cast<std::size_t>(reference.mesh.triangles.cols()), false);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (order[i].first == order[i - 1].first) {
            repeated[order[i].second] = true;
            ++reference.repair.repeated_facets;
        }
    if (reference.repair.repeated_facets == 0) return;
    std::vector<std::uint32_t>& from = reference.from;
    for (std::size_t t = 0; t < repeated.size(); ++t)
        if (!repeated[t]) from.push_back(static_cast<std::uint32_t>(t));
    reference.mesh.triangles = reference.mesh.triangles(Eigen::all, from).eval();
    if (reference.welded.cols() > 0) reference.welded = reference.welded(Eigen::all, from).eval();
}

} // namespace

double ReferenceMesh::rounding(const Eigen::Vector3d& place) const
{
    return float_rounding(std::max(size, place.cwiseAbs().maxCoeff()));
}

ReferenceMesh reference_mesh(Mesh mesh, Winding winding)
{
    ReferenceMesh reference;
    reference.mesh = std::move(mesh);
    Gaps gaps;
    tbb::parallel_invoke([&] { reference.size = typical_coordinate(reference.mesh.vertices); },
                         [&] { gaps = gaps_of(reference); });
    reference.repair.weld_tolerance = float_rounding(reference.size);
    weld_open(reference, gaps.open);
    if (reference.repair.welded_vertices > 0) gaps = gaps_of(reference);
    drop_repeated(reference, gaps);
    if (reference.repair.repeated_facets > 0) gaps = gaps_of(reference);
    if (winding == Winding::keep) return reference;
    const std::vector<std::uint32_t> wrong = wrongly_wound(reference.mesh.vertices, reference.facets(), gaps);
    if (wrong.empty() && winding == Winding::mend) return reference;
    std::vector<bool> turn(static_cast<std::size_t>(reference.mesh.triangles.cols()), winding == Winding::turn);
    for (const std::uint32_t t : wrong) turn[t].flip();
    for (std::size_t i = 0; i < turn.size(); ++i) {
        if (!turn[i]) continue;
        const auto t = static_cast<Eigen::Index>(i);
        std::swap(reference.mesh.triangles(1, t), reference.mesh.triangles(2, t));
        if (reference.welded.cols() > 0) std::swap(reference.welded(1, t), reference.welded(2, t));
        ++reference.repair.flipped_facets;
    }
    return reference;
}

} // namespace fettle
