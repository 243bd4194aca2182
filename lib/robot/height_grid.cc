#include "robot/height_grid.h"

#include "core/direction.h"
#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace fettle {

namespace {

using Eigen::Isometry3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kMostCells = 1 << 24; // a 4 m square of 1 mm
// What touches a cell by no more than this belongs to it, mm: roundings of coordinates.
constexpr double kTouch = 1e-9;

/// Highest and lowest point of a triangle in a cell.
struct Heights {
    double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
};

// By clipping to the four sides. Nothing is left of a triangle that a separating axis parts from the cell.
Heights heights_in(const Triangle& triangle, const Vector2d& least, const Vector2d& most)
{
    std::array<Vector3d, 7> in, out; // every side adds one corner at most
    std::size_t count = 3, kept = 0;
    for (std::size_t k = 0; k < 3; ++k) in[k] = triangle.col(static_cast<Eigen::Index>(k));
    for (int side = 0; side < 4; ++side, std::swap(in, out), count = kept) {
        const int axis = side / 2;
        const auto inside = [&](const Vector3d& p) {
            return side % 2 == 0 ? p[axis] - least[axis] + kTouch : most[axis] - p[axis] + kTouch;
        };
        kept = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Vector3d &p = in[i], &q = in[(i + 1) % count];
            const double at_p = inside(p), at_q = inside(q);
            if (at_p >= 0) out[kept++] = p;
            if ((at_p < 0) != (at_q < 0)) out[kept++] = p + at_p / (at_p - at_q) * (q - p);
        }
    }
    Heights found;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3d& p = in[i];
        found.highest = std::max(found.highest, p.z());
        found.lowest = std::min(found.lowest, p.z());
    }
    return found;
}

bool holds(const Triangle& t, const Vector2d& p)
{
    bool left = false, right = false;
    for (int k = 0; k < 3; ++k) {
        const Vector2d a = t.col(k).head<2>(), way = t.col((k + 1) % 3).head<2>() - a;
        const double side = way.x() * (p.y() - a.y()) - way.y() * (p.x() - a.x());
        left |= side > 0;
        right |= side < 0;
    }
    return !(left && right);
}

// Chen & Wei, eq. 12, of the cells of a triangle's box.
std::vector<std::uint32_t> with_a_corner_in(const HeightGrid& grid, const Triangle& t,
                                            const std::vector<std::uint32_t>& of_box)
{
    std::vector<std::uint32_t> found;
    for (const std::uint32_t c : of_box) {
        const Vector2d least =
            grid.cell * Vector2d(static_cast<double>(c % grid.columns), static_cast<double>(c / grid.columns));
        bool any = false;
        for (int k = 0; k < 4; ++k) any |= holds(t, least + grid.cell * Vector2d(k & 1, k >> 1));
        if (any) found.push_back(c);
    }
    return found.empty() ? of_box : found;
}

} // namespace

HeightGrid::HeightGrid(const Mesh& mesh, const Vector3d& up, double side, Formulas formulas) : cell(side)
{
    T_grid_part = turn_between(up, Vector3d::UnitZ());
    Eigen::Matrix3Xd points = T_grid_part * mesh.vertices;
    const Vector3d least = points.rowwise().minCoeff(), size = points.rowwise().maxCoeff() - least;
    T_grid_part.pretranslate(-least);
    points.colwise() -= least;
    if (!(std::ceil(size.x() / cell + 1) * std::ceil(size.y() / cell + 1) <= kMostCells))
        throw InputError("--cell: " + to_text(cell) + " mm would be more than 2^24 cells");
    columns = static_cast<Eigen::Index>(size.x() / cell) + 1;
    rows = static_cast<Eigen::Index>(size.y() / cell) + 1;
    heights.assign(index(0, rows), -1.0);
    std::vector<double> lowest(heights.size(), std::numeric_limits<double>::infinity());
    for (const auto corners : mesh.triangles.colwise()) {
        Triangle t;
        for (int k = 0; k < 3; ++k) t.col(k) = points.col(corners[k]);
        const auto range = [&](int axis, Eigen::Index count, double touch) {
            const double at = touch < 0 ? t.row(axis).minCoeff() : t.row(axis).maxCoeff();
            return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor((at + touch) / cell)), 0, count - 1);
        };
        std::vector<std::uint32_t> touched, of_box;
        for (Eigen::Index row = range(1, rows, -kTouch); row <= range(1, rows, kTouch); ++row)
            for (Eigen::Index column = range(0, columns, -kTouch); column <= range(0, columns, kTouch); ++column) {
                const auto c = static_cast<std::uint32_t>(index(column, row));
                of_box.push_back(c);
                const Vector2d from = cell * Vector2d(static_cast<double>(column), static_cast<double>(row));
                if (formulas == Formulas::right && std::isfinite(heights_in(t, from, from.array() + cell).highest))
                    touched.push_back(c);
            }
        if (formulas == Formulas::published) touched = with_a_corner_in(*this, t, of_box);
        for (const std::uint32_t c : touched) {
            const Vector2d from = cell * Vector2d(static_cast<double>(c % columns), static_cast<double>(c / columns));
            const Heights here = heights_in(t, from, from.array() + cell);
            // Of a cell that eq. 12 gives a triangle that does not touch it the nearest corner counts.
            const double highest = std::isfinite(here.highest) ? here.highest : t.row(2).maxCoeff();
            heights[c] = std::max(heights[c], highest);
            lowest[c] = std::min(lowest[c], std::min(here.lowest, highest));
        }
        cells_of.push_back(std::move(touched));
    }
    for (std::size_t c = 0; c < heights.size(); ++c)
        if (heights[c] >= 0) accuracy = std::max(accuracy, heights[c] - lowest[c]);
    accuracy = std::hypot(accuracy, std::numbers::sqrt2 * cell); // of a cell that is not full, its diagonal
}

Footprint HeightGrid::footprint(const Solid& solid, const Isometry3d& T_part_body, Formulas formulas) const
{
    const PlacedSolid placed(solid, T_grid_part * T_part_body);
    Footprint found = {Vector2d::Zero(), Vector2d::UnitX(), 0, 0};
    const auto* cylinder = std::get_if<solid::Cylinder>(&solid);
    Vector3d axis = Vector3d::Zero();
    const auto outline = placed.outline();
    if (const auto* round = std::get_if<RoundSolid>(&outline)) axis = round->T.linear().col(2);
    const double tilt = axis.head<2>().norm();
    if (tilt > kTouch) found.along = axis.head<2>() / tilt;
    const auto extent = [&](const Vector2d& way) {
        const Vector3d direction(way.x(), way.y(), 0);
        const double most = placed.farthest(direction).dot(direction) + placed.radius(),
                     least = placed.farthest(-direction).dot(direction) - placed.radius();
        found.centre += (most + least) / 2 * way;
        return (most - least) / 2;
    };
    found.half_along = extent(found.along);
    found.half_across = extent({-found.along.y(), found.along.x()});
    if (formulas == Formulas::published && cylinder != nullptr && tilt > kTouch)
        found.half_along = ((cylinder->to - cylinder->from).norm() + cylinder->radius) * tilt / 2;
    return found;
}

// By separating axes: those of the grid bound rows and columns, each of the rectangle's bounds the columns of a row.
void HeightGrid::mark(const Footprint& footprint, std::span<char> cells) const
{
    const Vector2d along = footprint.along, across(-along.y(), along.x());
    const Vector2d extent = (along * footprint.half_along).cwiseAbs() + (across * footprint.half_across).cwiseAbs();
    const double reach = cell / 2 * (std::abs(along.x()) + std::abs(along.y())) + kTouch; // of a cell along both
    const auto clamped = [&](double at, Eigen::Index count) {
        return static_cast<Eigen::Index>(std::clamp(std::floor(at / cell), 0.0, static_cast<double>(count - 1)));
    };
    const Vector2d least = footprint.centre - extent, most = footprint.centre + extent;
    if ((most.array() < -kTouch).any() || least.x() > cell * static_cast<double>(columns) + kTouch ||
        least.y() > cell * static_cast<double>(rows) + kTouch)
        return;
    for (Eigen::Index row = clamped(least.y() - kTouch, rows); row <= clamped(most.y() + kTouch, rows); ++row) {
        const double up = cell * (static_cast<double>(row) + 0.5) - footprint.centre.y();
        double from = least.x() - kTouch, to = most.x() + kTouch; // where cells may be touched
        for (const auto& [axis, half] :
             {std::pair(along, footprint.half_along), std::pair(across, footprint.half_across)}) {
            const double middle = footprint.centre.x() - up * axis.y() / axis.x(),
                         width = (half + reach) / std::abs(axis.x());
            if (!std::isfinite(middle) || !std::isfinite(width)) continue; // it bounds rows
            from = std::max(from, middle - width - cell / 2);
            to = std::min(to, middle + width + cell / 2);
        }
        if (from > to) continue;
        const Eigen::Index first = clamped(from, columns), last = clamped(to, columns);
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

Mesh HeightGrid::cuboids() const
{
    const int faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const std::vector<std::size_t> with_height = occupied();
    const auto count = static_cast<Eigen::Index>(with_height.size());
    Mesh mesh;
    mesh.vertices.resize(3, 8 * count);
    mesh.triangles.resize(3, 12 * count);
    const Isometry3d T_part_grid = T_grid_part.inverse();
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto c = static_cast<Eigen::Index>(with_height[static_cast<std::size_t>(i)]);
        const double height = heights[static_cast<std::size_t>(c)];
        for (int k = 0; k < 8; ++k)
            mesh.vertices.col(8 * i + k) =
                T_part_grid * Vector3d(cell * static_cast<double>(c % columns + (k & 1)),
                                       cell * static_cast<double>(c / columns + (k >> 1 & 1)), k & 4 ? height : 0.0);
        for (int f = 0; f < 12; ++f)
            for (int k = 0; k < 3; ++k) mesh.triangles(k, 12 * i + f) = static_cast<int>(8 * i) + faces[f][k];
    }
    return mesh;
}

double sphere_spacing(double radius, double tolerance)
{
    const double left = std::max(radius - tolerance, 0.0);
    return 2 * std::sqrt(radius * radius - left * left);
}

int sphere_count(double length, double spacing, Formulas formulas)
{
    const double count = length / spacing;
    return static_cast<int>(formulas == Formulas::published ? count + 0.5 : std::max(std::ceil(count), 1.0));
}

std::vector<solid::Sphere> sphere_row(const solid::Cylinder& cylinder, double tolerance, Formulas formulas)
{
    const Vector3d way = cylinder.to - cylinder.from;
    const int count = sphere_count(way.norm(), sphere_spacing(cylinder.radius, tolerance), formulas);
    std::vector<solid::Sphere> row;
    for (int i = 0; i < count; ++i) row.push_back({cylinder.from + (i + 0.5) / count * way, cylinder.radius});
    return row;
}

} // namespace fettle
