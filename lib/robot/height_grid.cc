#include "robot/height_grid.h"

#include "core/direction.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/clipping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kMaxCells = 1 << 24; // a square of 4 m with cells of 1 mm
// A cell is enlarged by this on all sides, mm: rounding of coordinates.
constexpr double kTouchTolerance = 1e-9;

/// Heights of the part of a triangle in a cell; infinite if there is none.
struct Heights {
    double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
};

Heights heights_in(const mesh::Triangle& triangle, const Eigen::AlignedBox2d& cell)
{
    Heights found;
    const geometry::ClippedTriangle<3> part(triangle, cell, kTouchTolerance);
    for (const Vector3d& p : part.corners()) {
        found.highest = std::max(found.highest, p.z());
        found.lowest = std::min(found.lowest, p.z());
    }
    return found;
}

// Is the point inside the triangle's projection?
bool contains(const mesh::Triangle& t, const Vector2d& p)
{
    bool left = false, right = false;
    for (int k = 0; k < 3; ++k) {
        const Vector2d a = t.col(k).head<2>(), edge = t.col((k + 1) % 3).head<2>() - a;
        const double side = edge.x() * (p.y() - a.y()) - edge.y() * (p.x() - a.x());
        left |= side > 0;
        right |= side < 0;
    }
    return !(left && right);
}

// Row or column at a coordinate; the first or last one outside the grid.
Eigen::Index cell_at(double coordinate, double cell_size, Eigen::Index count)
{
    return Eigen::Index(std::clamp(std::floor(coordinate / cell_size), 0.0, double(count - 1)));
}

// The corner of a cell with the smallest coordinates.
Vector2d min_corner(const HeightGrid& grid, std::uint32_t c)
{
    return grid.cell_size * Vector2d(c % grid.columns, c / grid.columns);
}

// Chen & Wei, eq. 12: of the cells in a triangle's bounding box those with a corner in it, or all of them.
std::vector<std::uint32_t> cells_with_corner_in(const HeightGrid& grid, const mesh::Triangle& t,
                                                const std::vector<std::uint32_t>& box_cells)
{
    std::vector<std::uint32_t> found;
    for (const std::uint32_t c : box_cells) {
        const Vector2d min = min_corner(grid, c);
        bool any = false;
        for (int k = 0; k < 4; ++k) any |= contains(t, min + grid.cell_size * Vector2d(k & 1, k >> 1));
        if (any) found.push_back(c);
    }
    return found.empty() ? box_cells : found;
}

} // namespace

HeightGrid::HeightGrid(const mesh::Mesh& mesh, const Vector3d& up, double side, Formulas formulas) : cell_size(side)
{
    T_grid_part = core::rotation_between(up, Vector3d::UnitZ());
    Eigen::Matrix3Xd points = T_grid_part * mesh.vertices;
    const Eigen::AlignedBox3d box = geometry::bounding_box(points);
    const Vector3d size = box.sizes();
    T_grid_part.pretranslate(-box.min());
    points.colwise() -= box.min();
    if (!(std::ceil(size.x() / cell_size + 1) * std::ceil(size.y() / cell_size + 1) <= kMaxCells))
        throw core::InputError("--cell: " + core::to_text(cell_size) + " mm gives more than 2^24 cells");
    columns = Eigen::Index(size.x() / cell_size) + 1;
    rows = Eigen::Index(size.y() / cell_size) + 1;
    heights.assign(index(0, rows), -1.0);
    std::vector<double> lowest(heights.size(), std::numeric_limits<double>::infinity());
    for (const auto corners : mesh.triangles.colwise()) {
        mesh::Triangle t;
        for (int k = 0; k < 3; ++k) t.col(k) = points.col(corners[k]);
        const auto clip = [&](std::uint32_t c) {
            const Vector2d corner = min_corner(*this, c);
            return heights_in(t, {corner, corner.array() + cell_size});
        };
        std::vector<std::uint32_t> cells, box_cells;
        const Vector2d from = t.topRows<2>().rowwise().minCoeff().array() - kTouchTolerance;
        const Vector2d to = t.topRows<2>().rowwise().maxCoeff().array() + kTouchTolerance;
        for (Eigen::Index row = cell_at(from.y(), cell_size, rows); row <= cell_at(to.y(), cell_size, rows); ++row)
            for (Eigen::Index column = cell_at(from.x(), cell_size, columns);
                 column <= cell_at(to.x(), cell_size, columns); ++column) {
                const std::uint32_t c = index(column, row);
                box_cells.push_back(c);
                if (formulas == Formulas::corrected && std::isfinite(clip(c).highest)) cells.push_back(c);
            }
        if (formulas == Formulas::published) cells = cells_with_corner_in(*this, t, box_cells);
        for (const std::uint32_t c : cells) {
            const Heights here = clip(c);
            // Eq. 12 may give a triangle a cell that it does not touch: that takes the height of its highest corner.
            const double highest = std::isfinite(here.highest) ? here.highest : t.row(2).maxCoeff();
            heights[c] = std::max(heights[c], highest);
            lowest[c] = std::min(lowest[c], std::min(here.lowest, highest));
        }
        triangle_cells.push_back(std::move(cells));
    }
    for (std::size_t c = 0; c < heights.size(); ++c)
        if (heights[c] >= 0) accuracy = std::max(accuracy, heights[c] - lowest[c]);
    accuracy = std::hypot(accuracy, std::numbers::sqrt2 * cell_size); // the surface may cover a corner of the cell only
}

Footprint HeightGrid::footprint(const Solid& solid, const Isometry3d& T_part_body, Formulas formulas) const
{
    const PlacedSolid placed(solid, T_grid_part * T_part_body);
    Footprint found = {Vector2d::Zero(), Vector2d::UnitX(), 0, 0};
    const auto* cylinder = std::get_if<solid::Cylinder>(&solid);
    Vector3d axis = Vector3d::Zero();
    const auto outline = placed.primitive_shape();
    if (const auto* round = std::get_if<RoundSolid>(&outline)) axis = round->T.linear().col(2);
    const double tilt = axis.head<2>().norm();
    if (tilt > kTouchTolerance) found.along = axis.head<2>() / tilt;
    const auto half_extent = [&](const Vector2d& direction2) {
        const Vector3d direction(direction2.x(), direction2.y(), 0);
        const double max = placed.support(direction).dot(direction) + placed.radius(),
                     min = placed.support(-direction).dot(direction) - placed.radius();
        found.centre += (max + min) / 2 * direction2;
        return (max - min) / 2;
    };
    found.half_along = half_extent(found.along);
    found.half_across = half_extent({-found.along.y(), found.along.x()});
    if (formulas == Formulas::published && cylinder != nullptr && tilt > kTouchTolerance)
        found.half_along = ((cylinder->to - cylinder->from).norm() + cylinder->radius) * tilt / 2;
    return found;
}

// Separating axes: those of the grid bound the rows and columns, those of the rectangle bound the columns of each row.
void HeightGrid::mark(const Footprint& footprint, std::span<char> cells) const
{
    const Vector2d along = footprint.along, across(-along.y(), along.x());
    const Vector2d extent = (along * footprint.half_along).cwiseAbs() + (across * footprint.half_across).cwiseAbs();
    // Half the extent of a cell along either axis of the rectangle.
    const double cell_extent = cell_size / 2 * (std::abs(along.x()) + std::abs(along.y())) + kTouchTolerance;
    const Vector2d min = footprint.centre - extent, max = footprint.centre + extent;
    if ((max.array() < -kTouchTolerance).any() || min.x() > cell_size * columns + kTouchTolerance ||
        min.y() > cell_size * rows + kTouchTolerance)
        return;
    for (Eigen::Index row = cell_at(min.y() - kTouchTolerance, cell_size, rows);
         row <= cell_at(max.y() + kTouchTolerance, cell_size, rows); ++row) {
        const double up = cell_size * (row + 0.5) - footprint.centre.y();
        double from = min.x() - kTouchTolerance,
               to = max.x() + kTouchTolerance; // x of the cells that the rectangle may touch
        for (const auto& [axis, half] :
             {std::pair(along, footprint.half_along), std::pair(across, footprint.half_across)}) {
            const double middle = footprint.centre.x() - up * axis.y() / axis.x(),
                         width = (half + cell_extent) / std::abs(axis.x());
            if (!std::isfinite(middle) || !std::isfinite(width)) continue; // an axis along y bounds no column
            from = std::max(from, middle - width - cell_size / 2);
            to = std::min(to, middle + width + cell_size / 2);
        }
        if (from > to) continue;
        const Eigen::Index first = cell_at(from, cell_size, columns), last = cell_at(to, cell_size, columns);
        std::fill(cells.begin() + index(first, row), cells.begin() + index(last, row) + 1, char{1});
    }
}

std::vector<std::size_t> HeightGrid::occupied() const
{
    std::vector<std::size_t> found;
    for (std::size_t c = 0; c < heights.size(); ++c)
        if (heights[c] >= 0) found.push_back(c);
    return found;
}

mesh::Mesh HeightGrid::cuboids() const
{
    const int faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const std::vector<std::size_t> cells = occupied();
    const Eigen::Index count = cells.size();
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 8 * count);
    mesh.triangles.resize(3, 12 * count);
    const Isometry3d T_part_grid = T_grid_part.inverse();
    for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index c = cells[i];
        for (int k = 0; k < 8; ++k)
            mesh.vertices.col(8 * i + k) =
                T_part_grid * Vector3d(cell_size * (c % columns + (k & 1)), cell_size * (c / columns + (k >> 1 & 1)),
                                       k & 4 ? heights[c] : 0.0);
        for (int f = 0; f < 12; ++f)
            for (int k = 0; k < 3; ++k) mesh.triangles(k, 12 * i + f) = 8 * i + faces[f][k];
    }
    return mesh;
}

double sphere_spacing(double radius, double tolerance)
{
    const double gap_radius = std::max(radius - tolerance, 0.0); // half-way between two spheres
    return 2 * std::sqrt(radius * radius - gap_radius * gap_radius);
}

int sphere_count(double length, double spacing, Formulas formulas)
{
    const double count = length / spacing;
    return int(formulas == Formulas::published ? count + 0.5 : std::max(std::ceil(count), 1.0));
}

std::vector<solid::Sphere> sphere_row(const solid::Cylinder& cylinder, double tolerance, Formulas formulas)
{
    const Vector3d axis = cylinder.to - cylinder.from;
    const int count = sphere_count(axis.norm(), sphere_spacing(cylinder.radius, tolerance), formulas);
    std::vector<solid::Sphere> row;
    for (int i = 0; i < count; ++i) row.push_back({cylinder.from + (i + 0.5) / count * axis, cylinder.radius});
    return row;
}

} // namespace fettle::robot
