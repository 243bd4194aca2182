#include "sampling/triangle_grid.h"

#include "geometry/bounding_box.h"
#include "mesh/facet_from_above.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle::sampling {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Each entry takes four bytes and one test per query in its cell. Smaller cells have fewer triangles that a query does
// not touch, but more entries.
constexpr double kTrianglesPerCell = 0.5;
// Long thin triangles are in many cells: the cells are enlarged until there are at most that many entries per triangle.
constexpr double kMaxEntriesPerTriangle = 16;

// The ball rests on the facet: its centre is at the distance of the radius along the upward normal, and the foot of
// that perpendicular must be in the triangle.
std::optional<double> centre_on_facet(const mesh::Mesh& mesh, Eigen::Index triangle, const Vector2d& xy, double radius)
{
    const Eigen::Vector3i t = mesh.triangles.col(triangle);
    const Vector3d a = mesh.vertices.col(t[0]);
    Vector3d normal = (mesh.vertices.col(t[1]) - a).cross(mesh.vertices.col(t[2]) - a);
    const double area = normal.norm();
    if (normal.z() == 0 || area == 0) return std::nullopt;
    normal *= (normal.z() > 0 ? 1 : -1) / area;
    const Vector2d foot = xy - radius * normal.head<2>();
    const auto z = mesh::FacetFromAbove(mesh, triangle).height(foot);
    if (!z) return std::nullopt;
    return *z + radius * normal.z();
}

// The ball rests on the edge a b: its centre is at distance R from the edge's line, with the foot between the ends.
// With m = xy - a, d the unit direction of the edge, d_h its horizontal part, d_z its vertical one, h = z - a_z:
//   |m|^2 + h^2 - (m · d_h + h d_z)^2 = R^2.
std::optional<double> centre_on_edge(const Vector3d& a, const Vector3d& b, const Vector2d& xy, double radius)
{
    const double length = (b - a).norm();
    const Vector3d d = (b - a) / length;
    const double flat = d.head<2>().squaredNorm();     // 1 - d_z^2
    if (length == 0 || flat == 0) return std::nullopt; // vertical edge: the ball rests on its upper vertex
    const Vector2d m = xy - a.head<2>();
    const double along = m.dot(d.head<2>());
    const double root = along * along * d.z() * d.z() - flat * (m.squaredNorm() - along * along - radius * radius);
    if (root < 0) return std::nullopt;
    const double h = (along * d.z() + std::sqrt(root)) / flat;
    const double foot = along + h * d.z();
    if (foot < 0 || foot > length) return std::nullopt;
    return a.z() + h;
}

std::optional<double> centre_on_vertex(const Vector3d& vertex, const Vector2d& xy, double radius)
{
    const double root = radius * radius - (xy - vertex.head<2>()).squaredNorm();
    if (root < 0) return std::nullopt;
    return vertex.z() + std::sqrt(root);
}

void raise_to(std::optional<double>& highest, const std::optional<double>& z)
{
    if (z && (!highest || *z > *highest)) highest = z;
}

} // namespace

TriangleGrid::TriangleGrid(const mesh::Mesh& mesh) : mesh_(mesh)
{
    const Eigen::AlignedBox3d box = geometry::finite_bounding_box(mesh_.vertices);
    origin_ = box.min().head<2>();
    const Vector2d extent = box.sizes().head<2>();
    const double triangles = mesh_.triangles.cols();
    const double longest = std::max(extent.maxCoeff(), std::numeric_limits<double>::min());
    // The shorter side may be 0 (a vertical sheet): then there are as many cells as triangles along the other side.
    cell_ = std::max(std::sqrt(extent.prod() * kTrianglesPerCell / triangles), longest / triangles);

    const auto cell_range = [this](Eigen::Index t) {
        const Eigen::AlignedBox2d around = geometry::bounding_box(mesh::triangle_of(mesh_, t).topRows<2>());
        return std::pair(cell_of(around.min()), cell_of(around.max()));
    };
    double entries = 0;
    do {
        if (entries > 0) cell_ *= 2;
        size_ = (extent / cell_).array().floor().cast<int>() + 1;
        entries = 0;
        for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
            const auto [low, high] = cell_range(t);
            entries += (high - low + Eigen::Vector2i::Ones()).cast<double>().prod();
        }
    } while (entries > kMaxEntriesPerTriangle * triangles && size_.maxCoeff() > 1);

    const auto for_each_cell = [&](Eigen::Index t, auto&& visit) {
        const auto [low, high] = cell_range(t);
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) visit(static_cast<std::size_t>(y) * size_.x() + x);
    };
    start_.assign(static_cast<std::size_t>(size_.x()) * size_.y() + 1, 0);
    for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t)
        for_each_cell(t, [this](std::size_t c) { ++start_[c + 1]; });
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    entries_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t)
        for_each_cell(t, [&](std::size_t c) { entries_[next[c]++] = t; });
}

Eigen::Vector2i TriangleGrid::cell_of(const Vector2d& xy) const
{
    const Eigen::Array2d cell = ((xy - origin_) / cell_).array().floor();
    return cell.max(0).min((size_.array() - 1).cast<double>()).cast<int>();
}

std::optional<double> TriangleGrid::highest(const Vector2d& xy) const
{
    std::optional<double> z;
    const Eigen::Vector2i cell = cell_of(xy);
    const std::size_t c = static_cast<std::size_t>(cell.y()) * size_.x() + cell.x();
    for (std::size_t e = start_[c]; e < start_[c + 1]; ++e)
        raise_to(z, mesh::FacetFromAbove(mesh_, entries_[e]).height(xy));
    return z;
}

std::optional<double> TriangleGrid::ball_centre(const Vector2d& xy, double radius) const
{
    std::optional<double> z;
    const Vector2d half_size = Vector2d::Constant(radius);
    visit(xy - half_size, xy + half_size, [&](Eigen::Index triangle) {
        raise_to(z, centre_on_facet(mesh_, triangle, xy, radius));
        const Eigen::Vector3i t = mesh_.triangles.col(triangle);
        for (int k = 0; k < 3; ++k) {
            const Vector3d a = mesh_.vertices.col(t[k]), b = mesh_.vertices.col(t[(k + 1) % 3]);
            raise_to(z, centre_on_edge(a, b, xy, radius));
            raise_to(z, centre_on_vertex(a, xy, radius));
        }
    });
    return z;
}

} // namespace fettle::sampling
