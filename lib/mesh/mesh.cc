#include "mesh/mesh.h"

#include "core/text.h"

#include <Eigen/Geometry>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <utility>
#include <vector>

namespace fettle::mesh {

namespace {

/// Hash of three corners that does not depend on their order. @param size  a power of two   @return  below `size`
std::size_t corner_hash(const Eigen::Vector3i& corners, std::size_t size)
{
    std::uint64_t sum = 0;
    for (const int corner : corners) { // the finalizer of SplitMix64 (Steele, Lea & Flood 2014) for each
        std::uint64_t z = (static_cast<std::uint64_t>(corner) + 1) * 0x9e3779b97f4a7c15;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        sum += z ^ (z >> 31);
    }
    return sum & (size - 1);
}

/// Triangles of which another may have the same corners, in any order: all that have one, and a few more, ascending.
std::vector<std::uint32_t> sharing_corners(const Eigen::Matrix3Xi& triangles)
{
    constexpr std::size_t kBitsPerTriangle = 16; // so that one in 16 triangles meets another's bit by chance
    const std::size_t size = std::bit_ceil(kBitsPerTriangle * static_cast<std::size_t>(triangles.cols()));
    std::vector<bool> seen(size, false), repeated(size, false);
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
        const std::size_t hash = corner_hash(triangles.col(t), size);
        if (seen[hash]) repeated[hash] = true;
        seen[hash] = true;
    }
    std::vector<std::uint32_t> sharing;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t)
        if (repeated[corner_hash(triangles.col(t), size)]) sharing.push_back(static_cast<std::uint32_t>(t));
    return sharing;
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
    struct Key {
        std::array<int, 3> corners; ///< ascending
        std::uint32_t index;
        bool reversed; ///< the triangle runs through its corners in descending order

        auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    for (const std::uint32_t t : sharing_corners(triangles)) {
        std::array<int, 3> c = {triangles(0, t), triangles(1, t), triangles(2, t)};
        std::rotate(c.begin(), std::ranges::min_element(c), c.end());
        const bool reversed = c[1] > c[2];
        if (reversed) std::swap(c[1], c[2]);
        if (c[0] != c[1] && c[1] != c[2]) keys.push_back({c, t, reversed}); // the others have no area
    }
    std::ranges::sort(keys);
    std::vector<std::uint32_t> opposite;
    for (std::size_t i = 0, first = 0; i < keys.size(); ++i) {
        if (keys[i].corners != keys[first].corners) first = i;
        if (keys[i].reversed != keys[first].reversed) opposite.push_back(keys[i].index);
    }
    std::ranges::sort(opposite);
    return opposite;
}

} // namespace fettle::mesh
