#include "belt/design_mesh.h"

#include "geometry/union_find.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::belt {
namespace {

int next_corner(int half_edge) { return half_edge - half_edge % 3 + (half_edge + 1) % 3; }

/// Pairs half-edges of opposite direction. An edge of other than two facets, or of two with the same direction, has no
/// twins.
std::vector<int> find_twins(const Eigen::Matrix3Xi& facets)
{
    const auto size = static_cast<int>(3 * facets.cols());
    std::vector<std::array<int, 3>> edges; // lower vertex, higher vertex, half-edge
    edges.reserve(size);
    for (int h = 0; h < size; ++h) {
        const int a = facets(h % 3, h / 3), b = facets((h + 1) % 3, h / 3);
        edges.push_back({std::min(a, b), std::max(a, b), h});
    }
    std::sort(edges.begin(), edges.end());
    std::vector<int> twins(size, -1);
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(
            first, edges.end(), [&](const auto& edge) { return edge[0] != (*first)[0] || edge[1] != (*first)[1]; });
        if (last - first == 2) {
            const int g = first[0][2], h = first[1][2];
            if (facets(g % 3, g / 3) != facets(h % 3, h / 3)) {
                twins[g] = h;
                twins[h] = g;
            }
        }
        first = last;
    }
    return twins;
}

Adjacency smooth_adjacency(const DesignMesh& design)
{
    Adjacency adjacency;
    const auto size = static_cast<int>(design.twins.size());
    for (int h = 0; h < size; ++h) {
        if (h % 3 == 0) adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
        if (!design.sharp[h]) adjacency.next.push_back(design.twins[h] / 3);
    }
    adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
    return adjacency;
}

/// Corners of a vertex that are connected across edges which are not sharp share a normal: the mean of the facet
/// normals, weighted by the angles at the corners (Thürmer & Wüthrich 1998).
Eigen::Matrix3Xd smooth_corner_normals(const DesignMesh& design)
{
    const auto size = static_cast<int>(design.twins.size());
    geometry::UnionFind smooth(size);
    for (int h = 0; h < size; ++h)
        if (!design.sharp[h]) smooth.join(h, next_corner(design.twins[h]));
    Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, size);
    for (int h = 0; h < size; ++h) {
        const Eigen::Vector3d here = design.corner(h);
        const Eigen::Vector3d a = design.corner(next_corner(h)) - here;
        const Eigen::Vector3d b = design.corner(next_corner(next_corner(h))) - here;
        sums.col(smooth.root(h)) += std::atan2(a.cross(b).norm(), a.dot(b)) * design.facet_normals.col(h / 3);
    }
    Eigen::Matrix3Xd normals(3, size);
    for (int h = 0; h < size; ++h) {
        const Eigen::Vector3d sum = sums.col(smooth.root(h));
        normals.col(h) = sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : design.facet_normals.col(h / 3);
    }
    return normals;
}

} // namespace

DesignMesh design_mesh(mesh::Mesh mesh, double sharp_angle)
{
    DesignMesh design;
    design.reference = compare::reference_mesh(std::move(mesh));
    const mesh::Mesh& placed = design.reference.mesh;
    design.facet_normals = mesh::triangle_normals(placed);
    design.areas.resize(placed.triangles.cols());
    for (Eigen::Index f = 0; f < placed.triangles.cols(); ++f) {
        const Eigen::Vector3i c = placed.triangles.col(f);
        const Eigen::Vector3d a = placed.vertices.col(c[0]);
        const Eigen::Vector3d ab = placed.vertices.col(c[1]) - a, ac = placed.vertices.col(c[2]) - a;
        design.areas[f] = ab.cross(ac).norm() / 2;
    }
    design.twins = find_twins(design.reference.facets());
    const double min_cosine = std::cos(sharp_angle);
    const auto is_degenerate = [&](int f) { return !(design.areas[f] > 0); };
    design.sharp.resize(design.twins.size());
    for (std::size_t h = 0; h < design.twins.size(); ++h) {
        const int f = static_cast<int>(h) / 3, g = design.twins[h] / 3;
        design.sharp[h] =
            design.twins[h] < 0 || (!is_degenerate(f) && !is_degenerate(g) &&
                                    design.facet_normals.col(f).dot(design.facet_normals.col(g)) < min_cosine);
    }
    design.adjacency = smooth_adjacency(design);
    design.corner_normals = smooth_corner_normals(design);
    return design;
}

std::vector<std::vector<int>> sharp_loops(const DesignMesh& design)
{
    std::vector<bool> is_visited(design.sharp.size(), false);
    std::vector<std::vector<int>> loops;
    for (int start = 0; start < static_cast<int>(design.sharp.size()); ++start) {
        if (!design.sharp[start] || is_visited[start]) continue;
        loops.emplace_back();
        for (int h = start; !is_visited[h];) {
            is_visited[h] = true;
            loops.back().push_back(h);
            h = next_corner(h);
            while (!design.sharp[h]) h = next_corner(design.twins[h]);
        }
    }
    return loops;
}

} // namespace fettle::belt
