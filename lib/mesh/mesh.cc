#include "mesh/mesh.h"

#include "core/text.h"
#include "core/uninitialized_vector.h"

#include <Eigen/Geometry>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace fettle::mesh {

namespace {

/// A triangle by its corners except for the lowest.
struct OtherCorners {
    int middle, highest;
    std::uint32_t triangle;

    auto operator<=>(const OtherCorners&) const = default;
    bool same_as(const OtherCorners& o) const { return middle == o.middle && highest == o.highest; }
};

/// Whether a triangle runs from its lowest corner to its highest, not to the middle one.
bool runs_down(const Eigen::Vector3i& corners)
{
    int lowest;
    corners.minCoeff(&lowest);
    return corners[(lowest + 1) % 3] > corners[(lowest + 2) % 3];
}

} // namespace

std::string repair_warning(const MeshRepair& repair)
{
    std::vector<std::string> dropped;
    const auto add = [&](Eigen::Index count, const char* one, const char* several, const char* which) {
        if (count > 0) dropped.push_back(std::to_string(count) + (count == 1 ? one : several) + which);
    };
    add(repair.dropped_triangles, " facet", " facets", " with NaN or infinite corners");
    add(repair.unused_vertices, " vertex", " vertices", " of no facet");
    return dropped.empty() ? "" : core::join(dropped, " and ") + " left out";
}

Eigen::Matrix3Xd triangle_normals(const Mesh& mesh)
{
    Eigen::Matrix3Xd unit(3, mesh.triangles.cols());
    for (Eigen::Index t = 0; t < unit.cols(); ++t) {
        const Triangle p = triangle_of(mesh, t);
        unit.col(t) = (p.col(1) - p.col(0))
                          .cross(p.col(2) - p.col(0))
                          .stableNormalized(); // tiny triangles would underflow otherwise
    }
    return unit;
}

Eigen::Matrix3Xi unique_triangles(const Eigen::Matrix3Xi& triangles)
{
    using Corners = std::array<int, 3>;
    std::vector<std::pair<Corners, Eigen::Index>> order;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
        const int a = triangles(0, t), b = triangles(1, t), c = triangles(2, t); // rotations of (a, b, c) are equal
        order.emplace_back(std::min({Corners{a, b, c}, Corners{b, c, a}, Corners{c, a, b}}), t);
    }
    tbb::parallel_sort(order);
    std::vector<Eigen::Index> first;
    for (std::size_t i = 0; i < order.size(); ++i)
        if (i == 0 || order[i].first != order[i - 1].first) first.push_back(order[i].second);
    std::sort(first.begin(), first.end());
    return triangles(Eigen::all, first);
}

std::vector<std::uint32_t> opposite_triangles(const Eigen::Matrix3Xi& triangles)
{
    if (triangles.cols() == 0) return {};
    // Counting sort by the lowest corner, which few triangles share. Each start advances to the start of the next
    // corner while the entries are filled in.
    std::vector<std::uint32_t> starts(triangles.maxCoeff() + 2, 0);
    for (const auto& corners : triangles.colwise()) ++starts[corners.minCoeff() + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    core::UninitializedVector<OtherCorners> others(triangles.cols());
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
        const int a = triangles(0, t), b = triangles(1, t), c = triangles(2, t);
        const int lowest = std::min({a, b, c}), highest = std::max({a, b, c}), middle = a ^ b ^ c ^ lowest ^ highest;
        others[starts[lowest]++] = {middle, highest, static_cast<std::uint32_t>(t)};
    }
    tbb::concurrent_vector<std::uint32_t> opposite;
    tbb::parallel_for(std::size_t{0}, starts.size() - 1, [&](std::size_t corner) {
        const std::span<OtherCorners> here(others.data() + (corner == 0 ? 0 : starts[corner - 1]),
                                           others.data() + starts[corner]);
        std::ranges::sort(here);
        for (std::size_t i = 1, first = 0; i < here.size(); ++i) {
            if (!here[i].same_as(here[first]))
                first = i;
            else if (static_cast<int>(corner) != here[i].middle && here[i].middle != here[i].highest && // has an area
                     runs_down(triangles.col(here[i].triangle)) != runs_down(triangles.col(here[first].triangle)))
                opposite.push_back(here[i].triangle);
        }
    });
    std::vector<std::uint32_t> sorted(opposite.begin(), opposite.end());
    std::ranges::sort(sorted);
    return sorted;
}

} // namespace fettle::mesh
