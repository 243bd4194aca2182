#include "geometry/bounding_box.h"
#include "removal/height_field.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "mesh/facet_from_above.h"
#include "removal/mesh_sides.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace fettle::removal {
namespace {

/// A scan may have pinholes; if a larger share of the anomaly has no surface, what to grind is not known.
constexpr double kMaxHoleShare = 0.01;

/// A cell's centre this close to a triangle is tested against it exactly; rounding is about 1e-12 of a cell.
constexpr double kEdgeToleranceCells = 1e-6;
/// One thread fills a band of rows at a time.
constexpr Eigen::Index kRowsPerBand = 32;

using CellRange = std::pair<Eigen::Index, Eigen::Index>; ///< first and end; empty unless first < end

/// The cells of a line of `count` whose centres lie from `low` to `high`.
CellRange cells_between(double low, double high, Eigen::Index count)
{
    const auto bounded = [count](double cell) { // NaN, from coordinates that overflow, gives no cells
        return cell > 0 ? Eigen::Index(std::min(cell, double(count))) : 0;
    };
    return {bounded(std::ceil(low - kEdgeToleranceCells)), bounded(std::floor(high + kEdgeToleranceCells) + 1)};
}

/// A triangle in grid coordinates: the centre of cell (i, j) is the point (i, j).
class FacetOverCells {
  public:
    FacetOverCells(const Eigen::Matrix2Xd& grid_points, const Eigen::Vector3i& corners)
    {
        for (int k = 0; k < 3; ++k) {
            edges_[k] = {grid_points.col(corners[k]), grid_points.col(corners[(k + 1) % 3]), 0};
            auto& [low, high, slope] = edges_[k];
            if (low.y() > high.y()) std::swap(low, high);
            if (low.y() < high.y()) slope = (high.x() - low.x()) / (high.y() - low.y());
        }
    }

    CellRange rows(Eigen::Index count) const
    {
        return cells_between(std::min({edges_[0].low.y(), edges_[1].low.y(), edges_[2].low.y()}),
                             std::max({edges_[0].high.y(), edges_[1].high.y(), edges_[2].high.y()}), count);
    }

    /// Columns of the part of the triangle that lies in a row, widened by kEdgeToleranceCells.
    CellRange columns(Eigen::Index row, Eigen::Index count) const
    {
        const double below = row - kEdgeToleranceCells, above = row + kEdgeToleranceCells;
        double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x;
        for (const auto& [low, high, slope] : edges_) {
            if (low.y() > above || high.y() < below) continue;
            const double enters = low.x() + (std::max(below, low.y()) - low.y()) * slope;
            const double leaves = low.x() + (std::min(above, high.y()) - low.y()) * slope;
            min_x = std::min({min_x, enters, leaves});
            max_x = std::max({max_x, enters, leaves});
        }
        return cells_between(min_x, max_x, count);
    }

  private:
    struct Edge {
        Eigen::Vector2d low, high;
        double slope; ///< dx / dy; 0 for a level edge, whose ends belong to the other two edges, too
    };
    Edge edges_[3];
};

/// What a cell shows of the mesh. A cell that no triangle covers shows nothing.
enum class Side : std::uint8_t { none, front, back };
using Sides = Eigen::Array<Side, Eigen::Dynamic, Eigen::Dynamic>;

/// A cell takes a triangle's height if that is its highest. Where two meet in a ridge, the one that faces up counts.
void raise_cell(double& z, Side& side, double height, Side shown)
{
    if (z > height || (z == height && side == Side::front)) return;
    z = height;
    side = shown;
}

/// Where a part of a body is missing, the inner side of what is below shows through: that is no surface.
void remove_inner_side(HeightField& field, const Sides& sides, const mesh::Mesh& mesh)
{
    const Side inner = is_inside_out(mesh) ? Side::front : Side::back;
    if (!(sides == inner).any() || !has_consistent_winding(mesh)) return;
    field.z = (sides == inner).select(core::kNaN, field.z);
}

/// Rasterizes a mesh, triangle by triangle: the highest z over each cell's centre, exactly as a vertical ray finds it.
void lay_mesh(HeightField& field, const mesh::Mesh& mesh)
{
    Sides sides = Sides::Constant(field.columns(), field.rows(), Side::none);
    const Eigen::Matrix2d R_working_machine = job::rotation_working_machine(field.theta);
    const Eigen::Matrix2d R_machine_working = R_working_machine.transpose();
    const Eigen::Matrix2Xd grid_points =
        (((R_working_machine * mesh.vertices.topRows<2>()).colwise() - field.origin) / field.cell).array() - 0.5;

    std::vector<std::vector<Eigen::Index>> bands(field.rows() / kRowsPerBand + 1); // triangles of each
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const auto [first, end] = FacetOverCells(grid_points, mesh.triangles.col(t)).rows(field.rows());
        for (Eigen::Index j = first; j < end; j = (j / kRowsPerBand + 1) * kRowsPerBand)
            bands[j / kRowsPerBand].push_back(t);
    }
    tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t band) {
        const Eigen::Index begin = Eigen::Index(band) * kRowsPerBand;
        for (const Eigen::Index t : bands[band]) {
            const mesh::FacetFromAbove facet(mesh, t);
            const Side side = faces_up(mesh, t) ? Side::front : Side::back;
            const FacetOverCells cells(grid_points, mesh.triangles.col(t));
            const auto [first_row, end_row] = cells.rows(field.rows());
            for (Eigen::Index j = std::max(first_row, begin); j < std::min(end_row, begin + kRowsPerBand); ++j) {
                const auto [first, end] = cells.columns(j, field.columns());
                for (Eigen::Index i = first; i < end; ++i) {
                    const auto z = facet.height(R_machine_working * field.centre(i, j));
                    if (z) raise_cell(field.z(i, j), sides(i, j), *z, side);
                }
            }
        }
    });
    remove_inner_side(field, sides, mesh);
}

using CellsByRow = std::vector<std::vector<CellRange>>; ///< ranges of each row, ascending

/// The cells of each row whose centres lie inside a polygon.
CellsByRow cells_inside(const HeightField& field, const job::Polygon& polygon)
{
    const auto first_centre = [&](double x) { // index of the first cell whose centre is not below x
        const double column = std::ceil((x - field.origin.x()) / field.cell - 0.5);
        return Eigen::Index(std::clamp(column, 0.0, double(field.columns())));
    };
    CellsByRow cells(field.rows());
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (const auto& [from, to] :
             job::intervals_inside(polygon, {0, field.centre(0, j).y()}, Eigen::Vector2d::UnitX()))
            cells[j].emplace_back(first_centre(from), first_centre(to));
    return cells;
}

/// The other cells of each row.
CellsByRow cells_outside(const HeightField& field, const CellsByRow& inside)
{
    CellsByRow cells(inside.size());
    for (std::size_t j = 0; j < inside.size(); ++j) {
        Eigen::Index next = 0;
        for (const auto& [first, end] : inside[j]) {
            cells[j].emplace_back(next, first);
            next = std::max(next, end);
        }
        cells[j].emplace_back(next, field.columns());
    }
    return cells;
}

/// Rasterizes a cloud, cell by cell. Beside the walls that a wheel leaves, Scan::height finds no surface, but the cloud
/// of a ground part has a point in each cell.
void lay_cloud(HeightField& field, const sampling::Scan& cloud, const CellsByRow& cells)
{
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(field.theta).transpose();
    tbb::parallel_for(Eigen::Index{0}, field.rows(), [&](Eigen::Index j) {
        for (const auto& [first, end] : cells[j])
            for (Eigen::Index i = first; i < end; ++i) {
                const Eigen::Vector2d xy = R_machine_working * field.centre(i, j);
                auto z = cloud.height(xy);
                if (!z) z = cloud.highest_point(xy, field.cell / 2);
                if (z) field.z(i, j) = *z;
            }
    });
}

/// @throws InputError if the field has a hole inside B
void require_material(const HeightField& field, const CellsByRow& B, const units::Units& units,
                      const std::string& source)
{
    Eigen::Index cells = 0, missing = 0;
    Eigen::Vector2d first_hole;
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (const auto& [first, end] : B[j])
            for (Eigen::Index i = first; i < end; ++i) {
                ++cells;
                if (!std::isnan(field.z(i, j))) continue;
                if (missing++ == 0)
                    first_hole = job::rotation_working_machine(field.theta).transpose() * field.centre(i, j);
            }
    if (missing <= kMaxHoleShare * cells) return;
    const double unit = units.mm();
    const auto number = [unit](double mm) { return core::to_text(std::round(mm / unit * 1000) / 1000); };
    throw core::InputError(source, "no surface over " + core::to_text(std::ceil(100.0 * missing / cells)) +
                                       " % of the anomaly, first at x " + number(first_hole.x()) + ", y " +
                                       number(first_hole.y()));
}

HeightField field_around(const job::Polygon& region, const job::Job& job, double cell)
try {
    return empty_height_field(geometry::bounding_box(region), {job.wheel.width / 2, job.wheel.radius}, job.theta, cell);
} catch (const core::InputError& error) {
    throw core::InputError(job.source, error.what());
}

} // namespace

void rasterize(HeightField& field, const sampling::Scan& scan)
{
    if (const mesh::Mesh* mesh = scan.mesh())
        lay_mesh(field, *mesh);
    else
        lay_cloud(field, scan, CellsByRow(field.rows(), {{0, field.columns()}}));
}

HeightField stock_from_scan(const sampling::Scan& scan, const job::Job& job, double cell, const std::string& source,
                            Extent extent)
{
    const auto [B, S] = job::working_boundaries(job);
    HeightField field = field_around(extent == Extent::sampling && S.size() > 0 ? S : B, job, cell);
    const CellsByRow inside = cells_inside(field, B);
    if (const mesh::Mesh* mesh = scan.mesh())
        lay_mesh(field, *mesh);
    else
        lay_cloud(field, scan, inside);
    require_material(field, inside, job.units, source);
    // What is around a hole in a cloud takes long, and is for nothing.
    if (scan.mesh() == nullptr) lay_cloud(field, scan, cells_outside(field, inside));
    return field;
}

HeightField stock_over_scan(const sampling::Scan& scan, double theta, double cell)
{
    const Eigen::Vector3d low = scan.bounds().min(), high = scan.bounds().max();
    Eigen::Matrix<double, 2, 4> corners;
    corners << low.x(), high.x(), high.x(), low.x(), low.y(), low.y(), high.y(), high.y();
    corners = (job::rotation_working_machine(theta) * corners).eval();
    HeightField field = empty_height_field(geometry::bounding_box(corners), {0, 0}, theta, cell);
    rasterize(field, scan);
    return field;
}

} // namespace fettle::removal
