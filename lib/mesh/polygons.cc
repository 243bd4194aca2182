#include "mesh/polygons.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numeric>

namespace fettle {

namespace {

// Twice the signed area of a triangle in the plane.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// The polygon seen along its normal: the coordinate that matters least is left out, the sense is kept.
Eigen::Matrix2Xd flattened(const Eigen::Matrix3Xd& corners)
{
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(); // Newell
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

bool is_ear(const Eigen::Matrix2Xd& flat, const std::vector<int>& ring, std::size_t at)
{
    const std::size_t n = ring.size();
    const Eigen::Vector2d a = flat.col(ring[(at + n - 1) % n]);
    const Eigen::Vector2d b = flat.col(ring[at]);
    const Eigen::Vector2d c = flat.col(ring[(at + 1) % n]);
    if (turn(a, b, c) <= 0) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
        const Eigen::Vector2d p = flat.col(ring[(at + k) % n]);
        if (p == a || p == b || p == c) continue;
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
}

} // namespace

std::vector<Eigen::Vector3i> cut_polygon(const Eigen::Matrix3Xd& vertices, std::span<const std::uint32_t> corners)
{
    const auto index = [&corners](int corner) { return static_cast<int>(corners[static_cast<std::size_t>(corner)]); };
    if (corners.size() == 3) return {{index(0), index(1), index(2)}};
    std::vector<Eigen::Vector3i> triangles;
    triangles.reserve(corners.size() - 2);
    std::vector<int> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0);
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(corners.size()));
    for (const int corner : ring) places.col(corner) = vertices.col(index(corner));
    const Eigen::Matrix2Xd flat = flattened(places);
    std::size_t at = 0;
    std::size_t tried = 0;
    while (ring.size() > 3) {
        // A polygon that crosses itself or has no area may have no ear: then any corner is cut, so that it ends.
        if (is_ear(flat, ring, at) || tried == ring.size()) {
            const std::size_t n = ring.size();
            triangles.emplace_back(index(ring[(at + n - 1) % n]), index(ring[at]), index(ring[(at + 1) % n]));
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
            tried = 0;
        } else {
            ++at;
            ++tried;
        }
        at %= ring.size();
    }
    triangles.emplace_back(index(ring[0]), index(ring[1]), index(ring[2]));
    return triangles;
}

Eigen::Matrix3Xi cut_polygons(const Eigen::Matrix3Xd& vertices, std::span<const std::uint32_t> corners,
                              std::span<const std::size_t> ends)
{
    Eigen::Matrix3Xi triangles(3, static_cast<Eigen::Index>(corners.size() - 2 * ends.size()));
    Eigen::Index filled = 0;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        for (const Eigen::Vector3i& triangle : cut_polygon(vertices, corners.subspan(begin, end - begin)))
            triangles.col(filled++) = triangle;
        begin = end;
    }
    return triangles;
}

Eigen::Index drop_undefined(Mesh& mesh)
{
    if (mesh.vertices.allFinite()) return 0;
    std::vector<int> place(static_cast<std::size_t>(mesh.vertices.cols()), -1);
    int kept = 0;
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i)
        if (mesh.vertices.col(i).allFinite()) {
            mesh.vertices.col(kept) = mesh.vertices.col(i).eval();
            place[static_cast<std::size_t>(i)] = kept++;
        }
    mesh.vertices.conservativeResize(3, kept);
    Eigen::Index triangles = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3i moved =
            mesh.triangles.col(t).unaryExpr([&place](int vertex) { return place[static_cast<std::size_t>(vertex)]; });
        if (moved.minCoeff() >= 0) mesh.triangles.col(triangles++) = moved;
    }
    const Eigen::Index dropped = mesh.triangles.cols() - triangles;
    mesh.triangles.conservativeResize(3, triangles);
    return dropped;
}

} // namespace fettle
