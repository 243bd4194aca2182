#include "compare/reference_mesh.h"

#include "compare/weld.h"
#include "compare/winding.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace fettle::compare {

namespace {

// Hash of a vertex number (the finalizer of SplitMix64, Steele, Lea & Flood 2014).
std::uint64_t hash(int vertex)
{
    std::uint64_t z = (static_cast<std::uint64_t>(vertex) + 1) * 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

/// Whether each vertex is open. Each half-edge that leaves a vertex adds the hash of its other end to the sum of the
/// vertex, each that arrives subtracts it: the sum is zero if they balance, and otherwise with probability 2^-64.
std::vector<bool> find_open(const Eigen::Matrix3Xi& facets, Eigen::Index vertices)
{
    std::vector<std::uint64_t> sum(vertices, 0);
    for (const auto& facet : facets.colwise()) {
        const std::uint64_t a = hash(facet[0]), b = hash(facet[1]), c = hash(facet[2]);
        sum[facet[0]] += b - c;
        sum[facet[1]] += c - a;
        sum[facet[2]] += a - b;
    }
    std::vector<bool> open(sum.size());
    for (std::size_t v = 0; v < sum.size(); ++v) open[v] = sum[v] != 0;
    return open;
}

int count_open(const std::vector<bool>& open, const Eigen::Vector3i& facet)
{
    return open[facet[0]] + open[facet[1]] + open[facet[2]];
}

OpenVertices open_vertices(const ReferenceMesh& reference)
{
    const Eigen::Matrix3Xi& facets = reference.facets();
    OpenVertices vertices{find_open(facets, reference.mesh.vertices.cols()), {}};
    constexpr Eigen::Index kFacetsPerTask = 1 << 16;
    std::vector<std::vector<std::uint32_t>> parts((facets.cols() + kFacetsPerTask - 1) / kFacetsPerTask);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
        const Eigen::Index first = p * kFacetsPerTask;
        for (Eigen::Index t = first; t < std::min(first + kFacetsPerTask, facets.cols()); ++t)
            if (count_open(vertices.open, facets.col(t)) >= 2) parts[p].push_back(t);
    });
    for (const auto& part : parts) vertices.facets.insert(vertices.facets.end(), part.begin(), part.end());
    return vertices;
}

bool is_closed(const OpenVertices& vertices)
{
    return std::find(vertices.open.begin(), vertices.open.end(), true) == vertices.open.end();
}

void weld_open(ReferenceMesh& reference, const std::vector<bool>& open)
{
    std::vector<std::int32_t> candidates;
    for (std::size_t v = 0; v < open.size(); ++v)
        if (open[v] && reference.mesh.vertices.col(v).allFinite()) candidates.push_back(v);
    const std::vector<std::int32_t> lowest =
        weld(reference.mesh.vertices, candidates, [&](const Eigen::Vector3d& v) { return reference.rounding_at(v); });
    for (std::size_t c = 0; c < lowest.size(); ++c) {
        if (lowest[c] == candidates[c]) continue;
        ++reference.repair.welded_vertices;
        const double distance =
            (reference.mesh.vertices.col(lowest[c]) - reference.mesh.vertices.col(candidates[c])).norm();
        reference.max_weld_distance = std::max(reference.max_weld_distance, distance);
    }
    if (reference.repair.welded_vertices == 0) return;
    std::vector<std::int32_t> welded(open.size());
    std::iota(welded.begin(), welded.end(), 0);
    for (std::size_t c = 0; c < lowest.size(); ++c) welded[candidates[c]] = lowest[c];
    reference.welded = reference.mesh.triangles.unaryExpr([&](int v) { return welded[v]; });
}

void drop_facets(ReferenceMesh& reference, const std::vector<bool>& dropped)
{
    std::vector<std::uint32_t> kept, original_indices;
    for (std::uint32_t t = 0; t < dropped.size(); ++t) {
        if (dropped[t]) continue;
        kept.push_back(t);
        original_indices.push_back(static_cast<std::uint32_t>(reference.original_index(t)));
    }
    reference.original_indices = std::move(original_indices);
    reference.mesh.triangles = reference.mesh.triangles(Eigen::all, kept).eval();
    if (reference.welded.cols() > 0) reference.welded = reference.welded(Eigen::all, kept).eval();
}

/// Drops facets that duplicate an earlier one with the same winding: thousands of them would all be visited for every
/// query. All corners of such a facet are open.
void drop_repeated(ReferenceMesh& reference, const OpenVertices& vertices)
{
    using Corners = std::array<int, 3>;
    std::vector<std::pair<Corners, std::uint32_t>> order;
    for (const std::uint32_t t : vertices.facets) {
        const Eigen::Vector3i f = reference.facets().col(t);
        if (count_open(vertices.open, f) < 3) continue;
        // The smallest of the three rotations identifies the facet.
        order.emplace_back(std::min({Corners{f[0], f[1], f[2]}, Corners{f[1], f[2], f[0]}, Corners{f[2], f[0], f[1]}}),
                           t);
    }
    std::sort(order.begin(), order.end());
    std::vector<bool> repeated(reference.mesh.triangles.cols(), false);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (order[i].first == order[i - 1].first) {
            repeated[order[i].second] = true;
            ++reference.repair.repeated_facets;
        }
    if (reference.repair.repeated_facets > 0) drop_facets(reference, repeated);
}

/// Drops facets that have the corners of an earlier one and the other winding. Where both are, a point's sign would
/// depend on which of the two the search finds first.
void drop_opposite(ReferenceMesh& reference)
{
    const std::vector<std::uint32_t> opposite = mesh::opposite_triangles(reference.facets());
    if (opposite.empty()) return;
    std::vector<bool> dropped(reference.mesh.triangles.cols(), false);
    for (const std::uint32_t t : opposite) dropped[t] = true;
    drop_facets(reference, dropped);
    reference.repair.opposite_facets = static_cast<Eigen::Index>(opposite.size());
}

} // namespace

double ReferenceMesh::rounding_at(const Eigen::Vector3d& point) const
{
    return float_rounding(std::max(coordinate, point.cwiseAbs().maxCoeff()));
}

ReferenceMesh reference_mesh(mesh::Mesh mesh, Winding winding)
{
    ReferenceMesh reference;
    reference.mesh = std::move(mesh);
    OpenVertices vertices;
    tbb::parallel_invoke([&] { reference.coordinate = median_coordinate(reference.mesh.vertices); },
                         [&] { vertices = open_vertices(reference); });
    reference.repair.weld_tolerance = float_rounding(reference.coordinate);
    weld_open(reference, vertices.open);
    if (reference.repair.welded_vertices > 0) vertices = open_vertices(reference);
    drop_repeated(reference, vertices);
    drop_opposite(reference);
    if (reference.repair.repeated_facets + reference.repair.opposite_facets > 0) vertices = open_vertices(reference);
    reference.closed = is_closed(vertices);
    if (winding == Winding::keep) return reference;
    const std::vector<std::uint32_t> wrong = facets_to_flip(reference.mesh.vertices, reference.facets(), vertices);
    if (wrong.empty() && winding == Winding::repair) return reference;
    std::vector<bool> flip(reference.mesh.triangles.cols(), winding == Winding::flip);
    for (const std::uint32_t t : wrong) flip[t].flip();
    for (std::size_t t = 0; t < flip.size(); ++t) {
        if (!flip[t]) continue;
        std::swap(reference.mesh.triangles(1, t), reference.mesh.triangles(2, t));
        if (reference.welded.cols() > 0) std::swap(reference.welded(1, t), reference.welded(2, t));
        ++reference.repair.flipped_facets;
    }
    reference.closed = is_closed(open_vertices(reference));
    return reference;
}

} // namespace fettle::compare
