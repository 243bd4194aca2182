#include "mesh/polygons.h"

#include <Eigen/Geometry>

#include <numeric>

namespace fettle::mesh {

namespace {

/// Twice the signed area of a triangle in the plane, positive if counter-clockwise.
double doubled_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Projects a polygon on the coordinate plane nearest to its own plane, keeping its orientation.
Eigen::Matrix2Xd project_to_plane(const Eigen::Matrix3Xd& corners)
{
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(); // area vector, Newell's method
    for (Eigen::Index i = 0; i < corners.cols(); ++i) {
        const Eigen::Vector3d a = corners.col(i) - corners.col(0);
        const Eigen::Vector3d b = corners.col((i + 1) % corners.cols()) - corners.col(0);
        normal += a.cross(b);
    }
    Eigen::Index dropped = 0;
    normal.cwiseAbs().maxCoeff(&dropped);
    const Eigen::Index u = (dropped + 1) % 3;
    const Eigen::Index v = (dropped + 2) % 3;
    Eigen::Matrix2Xd flat(2, corners.cols());
    flat.row(0) = corners.row(normal[dropped] < 0 ? v : u);
    flat.row(1) = corners.row(normal[dropped] < 0 ? u : v);
    return flat;
}

/// True if the corners next to `tip` see each other inside the polygon.
bool is_ear(const Eigen::Matrix2Xd& flat, const std::vector<int>& ring, std::size_t tip)
{
    const std::size_t n = ring.size();
    const Eigen::Vector2d a = flat.col(ring[(tip + n - 1) % n]);
    const Eigen::Vector2d b = flat.col(ring[tip]);
    const Eigen::Vector2d c = flat.col(ring[(tip + 1) % n]);
    if (doubled_area(a, b, c) <= 0) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
        const Eigen::Vector2d p = flat.col(ring[(tip + k) % n]);
        if (p == a || p == b || p == c) continue;
        if (doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0) return false;
    }
    return true;
}

} // namespace

std::vector<Eigen::Vector3i> triangulate_polygon(const Eigen::Matrix3Xd& vertices,
                                                 std::span<const std::uint32_t> corners)
{
    const auto index = [&corners](int corner) { return static_cast<int>(corners[corner]); };
    if (corners.size() == 3) return {{index(0), index(1), index(2)}};
    std::vector<Eigen::Vector3i> triangles;
    triangles.reserve(corners.size() - 2);
    std::vector<int> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0);
    Eigen::Matrix3Xd polygon(3, corners.size());
    for (const int corner : ring) polygon.col(corner) = vertices.col(index(corner));
    const Eigen::Matrix2Xd flat = project_to_plane(polygon);
    std::size_t tip = 0;
    std::size_t tried = 0;
    while (ring.size() > 3) {
        // A self-intersecting or degenerate polygon may have no ear: then any corner is cut off, so that the loop ends.
        if (is_ear(flat, ring, tip) || tried == ring.size()) {
            const std::size_t n = ring.size();
            triangles.emplace_back(index(ring[(tip + n - 1) % n]), index(ring[tip]), index(ring[(tip + 1) % n]));
            ring.erase(ring.begin() + tip);
            tried = 0;
        } else {
            ++tip;
            ++tried;
        }
        tip %= ring.size();
    }
    triangles.emplace_back(index(ring[0]), index(ring[1]), index(ring[2]));
    return triangles;
}

Eigen::Matrix3Xi triangulate_polygons(const Eigen::Matrix3Xd& vertices, std::span<const std::uint32_t> corners,
                                      std::span<const std::size_t> ends)
{
    Eigen::Matrix3Xi triangles(3, corners.size() - 2 * ends.size());
    Eigen::Index filled = 0;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        for (const Eigen::Vector3i& triangle : triangulate_polygon(vertices, corners.subspan(begin, end - begin)))
            triangles.col(filled++) = triangle;
        begin = end;
    }
    return triangles;
}

Eigen::Index drop_nonfinite(Mesh& mesh)
{
    if (mesh.vertices.allFinite()) return 0;
    std::vector<int> new_index(mesh.vertices.cols(), -1);
    int kept = 0;
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i)
        if (mesh.vertices.col(i).allFinite()) {
            mesh.vertices.col(kept) = mesh.vertices.col(i).eval();
            new_index[i] = kept++;
        }
    mesh.vertices.conservativeResize(3, kept);
    Eigen::Index triangles = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3i corners = mesh.triangles.col(t).unaryExpr([&](int vertex) { return new_index[vertex]; });
        if (corners.minCoeff() >= 0) mesh.triangles.col(triangles++) = corners;
    }
    const Eigen::Index dropped = mesh.triangles.cols() - triangles;
    mesh.triangles.conservativeResize(3, triangles);
    return dropped;
}

Eigen::Index drop_unused_vertices(Mesh& mesh)
{
    std::vector<int> new_index(mesh.vertices.cols(), -1);
    for (const int corner : mesh.triangles.reshaped()) new_index[corner] = 0;
    int kept = 0;
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i)
        if (new_index[i] == 0) {
            mesh.vertices.col(kept) = mesh.vertices.col(i).eval();
            new_index[i] = kept++;
        }
    const Eigen::Index dropped = mesh.vertices.cols() - kept;
    if (dropped == 0) return 0;
    mesh.vertices.conservativeResize(3, kept);
    mesh.triangles = mesh.triangles.unaryExpr([&](int vertex) { return new_index[vertex]; }).eval();
    return dropped;
}

} // namespace fettle::mesh
