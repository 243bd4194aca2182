#include "removal/mesh_sides.h"

#include "geometry/bounding_box.h"

#include <Eigen/Geometry>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fettle::removal {
namespace {

/// A mesh is a sheet that faces up if the triangles that face down take back less than half of the area.
constexpr double kMinSheetShare = 0.5;
/// A smaller volume, relative to the area and the size, is that of a flat sheet, not of a body.
constexpr double kMinVolumeShare = 0.01;
/// Share of the edges that two triangles run along in the same direction: where it is larger, the winding says nothing.
constexpr double kMaxTwistedShare = 0.01;
/// Share of the edges with a neighbour beyond. Where it is smaller, the triangles share no vertices.
constexpr double kMinSharedShare = 0.5;

using Edge = std::pair<int, int>;

/// Twice the triangle's area vector, along its normal.
Eigen::Vector3d area_vector(const mesh::Triangle& p) { return (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)); }

} // namespace

bool faces_up(const mesh::Mesh& mesh, Eigen::Index triangle)
{
    return area_vector(mesh::triangle_of(mesh, triangle)).z() >= 0;
}

bool is_inside_out(const mesh::Mesh& mesh)
{
    const Eigen::AlignedBox3d box =
        geometry::finite_bounding_box(mesh.vertices); // of dropped facets there may be others
    const Eigen::Vector3d middle = box.center();
    const double size = box.diagonal().norm();
    double up = 0, covered = 0, all = 0, volume = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const mesh::Triangle corners = mesh::triangle_of(mesh, t);
        const Eigen::Vector3d area = area_vector(corners);
        up += area.z();
        covered += std::abs(area.z());
        all += area.norm();
        volume += area.dot(corners.col(0) - middle);
    }
    if (up > kMinSheetShare * covered) return false;
    return std::abs(volume) > kMinVolumeShare * all * size ? volume < 0 : up < 0;
}

bool has_consistent_winding(const mesh::Mesh& mesh)
{
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.cols());
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k) edges.emplace_back(mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t));
    tbb::parallel_sort(edges);
    double twisted = 0, shared = 0;
    for (std::size_t n = 0; n < edges.size(); ++n) {
        if (n > 0 && edges[n] == edges[n - 1]) ++twisted;
        if (std::ranges::binary_search(edges, Edge(edges[n].second, edges[n].first))) ++shared;
    }
    const double count = double(edges.size());
    return twisted <= kMaxTwistedShare * count && shared >= kMinSharedShare * count;
}

} // namespace fettle::removal
