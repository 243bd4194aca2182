#include "belt/design_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace fettle {
namespace {

int next_corner(int half_edge) { return half_edge - half_edge % 3 + (half_edge + 1) % 3; }

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Two facets that run along an edge in opposite ways are side by side; any other number of them is none.
std::vector<int> twins_of(const Eigen::Matrix3Xi& facets)
{
    const auto size = static_cast<int>(3 * facets.cols());
    std::vector<std::tuple<int, int, int>> edges; // lower vertex, higher vertex, half-edge
    edges.reserve(at(size));
    for (int h = 0; h < size; ++h) {
        const int a = facets(h % 3, h / 3), b = facets((h + 1) % 3, h / 3);
        edges.emplace_back(std::min(a, b), std::max(a, b), h);
    }
    std::sort(edges.begin(), edges.end());
    std::vector<int> twins(at(size), -1);
    const auto same = [](const auto& e, const auto& f) {
        return std::get<0>(e) == std::get<0>(f) && std::get<1>(e) == std::get<1>(f);
    };
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const auto& edge) { return !same(edge, *first); });
        if (last - first == 2) {
            const int g = std::get<2>(first[0]), h = std::get<2>(first[1]);
            if (facets(g % 3, g / 3) != facets(h % 3, h / 3)) {
                twins[at(g)] = h;
                twins[at(h)] = g;
            }
        }
        first = last;
    }
    return twins;
}

Adjacency adjacency_of(const DesignMesh& design)
{
    Adjacency adjacency;
    const auto size = static_cast<int>(design.twins.size());
    for (int h = 0; h < size; ++h) {
        if (h % 3 == 0) adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
        if (!design.sharp[at(h)]) adjacency.next.push_back(design.twins[at(h)] / 3);
    }
    adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
    return adjacency;
}

/// Corners at one vertex whose facets are side by side over edges that are not sharp have one normal: the facets', by
/// their angles there (Thürmer & Wüthrich 1998).
Eigen::Matrix3Xd corner_normals_of(const DesignMesh& design)
{
    const auto size = static_cast<int>(design.twins.size());
    std::vector<int> parent(at(size));
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int corner) {
        while (parent[at(corner)] != corner) corner = parent[at(corner)] = parent[at(parent[at(corner)])];
        return corner;
    };
    const auto join = [&](int a, int b) {
        a = root(a);
        b = root(b);
        parent[at(std::max(a, b))] = std::min(a, b);
    };
    for (int h = 0; h < size; ++h) {
        if (design.sharp[at(h)]) continue;
        join(h, next_corner(design.twins[at(h)]));
    }
    Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, size);
    for (int h = 0; h < size; ++h) {
        const Eigen::Vector3d here = design.corner(h);
        const Eigen::Vector3d a = design.corner(next_corner(h)) - here;
        const Eigen::Vector3d b = design.corner(next_corner(next_corner(h))) - here;
        sums.col(root(h)) += std::atan2(a.cross(b).norm(), a.dot(b)) * design.facet_normals.col(h / 3);
    }
    Eigen::Matrix3Xd normals(3, size);
    for (int h = 0; h < size; ++h) {
        const Eigen::Vector3d sum = sums.col(root(h));
        normals.col(h) = sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : design.facet_normals.col(h / 3);
    }
    return normals;
}

} // namespace

DesignMesh design_mesh(Mesh mesh, double angle)
{
    DesignMesh design;
    design.reference = reference_mesh(std::move(mesh));
    const Mesh& placed = design.reference.mesh;
    design.facet_normals = triangle_normals(placed);
    design.areas.resize(placed.triangles.cols());
    for (Eigen::Index f = 0; f < placed.triangles.cols(); ++f) {
        const Eigen::Vector3i c = placed.triangles.col(f);
        const Eigen::Vector3d a = placed.vertices.col(c[0]);
        const Eigen::Vector3d ab = placed.vertices.col(c[1]) - a, ac = placed.vertices.col(c[2]) - a;
        design.areas[f] = ab.cross(ac).norm() / 2;
    }
    design.twins = twins_of(design.reference.facets());
    const double least = std::cos(angle);
    const auto directed = [&](int f) { return design.areas[f] > 0; };
    design.sharp.resize(design.twins.size());
    for (std::size_t h = 0; h < design.twins.size(); ++h) {
        const int f = static_cast<int>(h) / 3, g = design.twins[h] / 3;
        design.sharp[h] = design.twins[h] < 0 || (directed(f) && directed(g) &&
                                                  design.facet_normals.col(f).dot(design.facet_normals.col(g)) < least);
    }
    design.adjacency = adjacency_of(design);
    design.corner_normals = corner_normals_of(design);
    return design;
}

std::vector<std::vector<int>> sharp_loops(const DesignMesh& design)
{
    std::vector<bool> seen(design.sharp.size(), false);
    std::vector<std::vector<int>> loops;
    for (int start = 0; start < static_cast<int>(design.sharp.size()); ++start) {
        if (!design.sharp[at(start)] || seen[at(start)]) continue;
        loops.emplace_back();
        for (int h = start; !seen[at(h)];) {
            seen[at(h)] = true;
            loops.back().push_back(h);
            h = next_corner(h);
            while (!design.sharp[at(h)]) h = next_corner(design.twins[at(h)]);
        }
    }
    return loops;
}

} // namespace fettle
