#include "fit/dense_points.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/text.h"
#include "fit/bspline.h"
#include "geometry/bounding_box.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kMinPoints = 6; // the coefficients of a quadratic

// Two cells for each point along a side, as long as factorising their equations takes no longer than reading the
// points: its cost grows with the fourth power of the cells on a side.
constexpr double kMinCells = 12;
constexpr double kMaxCells = 64;
// Share of the longer side by which the grid exceeds the points on each side: room for the wheel's footprint.
constexpr double kBorderShare = 1 / 12.0;

/// Bounding box and moments of the points, W.
struct Extent {
    Eigen::AlignedBox2d box;
    Vector2d sum = Vector2d::Zero(); ///< relative to the middle of B
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    double max_abs_coordinate = 0;
    std::size_t count = 0;
    std::size_t overhang = 0; ///< points whose normal points down or sideways
    std::size_t bad_role_point = std::numeric_limits<std::size_t>::max(); ///< index of the first such point
    double bad_role = 0;

    void add(const Extent& other)
    {
        box.extend(other.box);
        sum += other.sum;
        squares += other.squares;
        max_abs_coordinate = std::max(max_abs_coordinate, other.max_abs_coordinate);
        count += other.count;
        overhang += other.overhang;
        add_bad_role(other.bad_role_point, other.bad_role);
    }
    void add_bad_role(std::size_t point, double role)
    {
        if (point < bad_role_point) std::tie(bad_role_point, bad_role) = std::pair(point, role);
    }
};

// Minimum z of a point's unit normal: on a wall steeper than 84° a height is ten times as uncertain as the scan.
constexpr double kMinNormalZ = 0.1;

/// False for NaN: nothing is known of the point's side.
bool is_overhang(const cloud::PointBlock& block, Index i)
{
    return block.normal_z.size() > 0 && block.normal_z[i] < kMinNormalZ;
}

bool finite(const Eigen::Vector3d& p) { return std::isfinite(p.x() + p.y() + p.z()); }

Extent measure_extent(const DensePoints& points, const Eigen::Matrix2d& rotation, const Vector2d& middle)
{
    const bool bounded = points.region.sampling.cols() > 0;
    const Vector2d infinite = Vector2d::Constant(kInfinite);
    const Eigen::AlignedBox2d bounds =
        bounded ? geometry::bounding_box(points.region.sampling) : Eigen::AlignedBox2d(-infinite, infinite);
    std::array<Extent, kNumLanes> lanes;
    parallel_for_blocks(points.source, [&](std::size_t lane, std::size_t first, const cloud::PointBlock& block) {
        Extent& e = lanes[lane];
        for (Index i = 0; i < block.xyz.cols(); ++i) {
            if (points.source.has_roles) {
                const double role = block.roles[i];
                if (!(role >= 0 && role <= kMaxRole && role == std::floor(role))) e.add_bad_role(first + i, role);
                if (!is_used_role(role, kSampleRoles, points.filter.use_boundary)) continue;
            }
            const Eigen::Vector3d p = block.xyz.col(i);
            if (!finite(p)) continue;
            if (is_overhang(block, i)) {
                ++e.overhang;
                continue;
            }
            const Vector2d w = rotation * p.head<2>();
            if (!bounds.contains(w)) continue;
            e.box.extend(w);
            const Vector2d d = w - middle;
            e.sum += d;
            e.squares += d * d.transpose();
            e.max_abs_coordinate = std::max(e.max_abs_coordinate, p.cwiseAbs().maxCoeff());
            ++e.count;
        }
    });
    for (std::size_t lane = 1; lane < kNumLanes; ++lane) lanes[0].add(lanes[lane]);
    return lanes[0];
}

void check_extent(const Extent& extent, const job::Job& job, const std::string& name, std::size_t all)
{
    if (extent.bad_role_point < all)
        throw core::InputError(name, "point " + std::to_string(extent.bad_role_point) + ": " +
                                         core::to_text(extent.bad_role) + " is not a role (0 to 5)");
    const std::string overhang =
        extent.overhang == 0 ? "" : "; " + std::to_string(extent.overhang) + " face down or sideways by their normals";
    if (extent.count < kMinPoints)
        throw core::InputError(name, "a fit needs at least " + std::to_string(kMinPoints) + " touches, got " +
                                         std::to_string(extent.count) + " of " + std::to_string(all) +
                                         " points that it may use" + overhang);
    const double n = extent.count;
    const Vector2d mean = extent.sum / n;
    const core::SymmetricEigen<2> spread = core::symmetric_eigen<2>(extent.squares / n - mean * mean.transpose());
    if (std::sqrt(std::max(spread.values[0], 0.0)) <= job.probe.accuracy)
        throw core::InputError(name, "touches lie on one line in x and y");
}

surface::Bspline grid_over(const Extent& extent, const job::Job& job, const Eigen::Matrix2d& rotation)
{
    const Eigen::Matrix2Xd anomaly = rotation * job.anomaly.topRows<2>();
    const double cells = std::clamp(std::ceil(2 * std::sqrt(extent.count)), kMinCells, kMaxCells);
    const double border = std::ceil(cells * kBorderShare / (1 + 2 * kBorderShare));
    return make_spline_grid(extent.box.merged(geometry::bounding_box(anomaly)), cells - 2 * border, border, job.theta);
}

/// Classifies the disc of a given radius about w. @param w  W
DensePoints::Cell classify_disc(const job::Boundaries& region, const Vector2d& w, double radius)
{
    const job::Polygon& B = region.anomaly;
    const job::Polygon& S = region.sampling;
    const bool on_anomaly_edge = job::distance_to_edge(B, w) <= radius;
    const bool on_sampling_edge = S.cols() > 0 && job::distance_to_edge(S, w) <= radius;
    if (on_anomaly_edge && on_sampling_edge) return DensePoints::edge_of_both;
    if (!on_anomaly_edge && job::contains(B, w)) return DensePoints::drop_anomaly;
    if (!on_sampling_edge && S.cols() > 0 && !job::contains(S, w)) return DensePoints::drop_outside;
    if (on_anomaly_edge) return DensePoints::edge_of_anomaly;
    return on_sampling_edge ? DensePoints::edge_of_sampling : DensePoints::take;
}

/// Classifies the cells by their circumscribed discs, and the subcells of those that edges may cross.
void classify_cells(DensePoints& points, const Eigen::Matrix2d& rotation)
{
    constexpr int kSubcells = DensePoints::kSubcells;
    const Index cells_u = points.grid.heights.rows() - 3, cells_v = points.grid.heights.cols() - 3;
    points.cells.assign(cells_u * cells_v, DensePoints::take);
    points.first_subcell.assign(points.cells.size(), -1);
    if (points.region.anomaly.cols() == 0) return;
    const double radius = points.grid.cell.norm() / 2;
    const auto classify = [&](Index cell, const Vector2d& offset, double disc_radius) {
        const Vector2d corner(cell % cells_u, cell / cells_u);
        return classify_disc(points.region, rotation * machine_from_grid(points.grid, corner + offset), disc_radius);
    };
    tbb::parallel_for(std::size_t{0}, points.cells.size(), [&](std::size_t k) {
        points.cells[k] = classify(k, {0.5, 0.5}, radius);
    });
    std::vector<std::size_t> crossed;
    for (std::size_t k = 0; k < points.cells.size(); ++k) {
        if (points.cells[k] <= DensePoints::drop_outside) continue;
        points.first_subcell[k] = kSubcells * kSubcells * crossed.size();
        crossed.push_back(k);
    }
    points.subcells.resize(kSubcells * kSubcells * crossed.size());
    tbb::parallel_for(std::size_t{0}, points.subcells.size(), [&](std::size_t k) {
        const int i = k % (kSubcells * kSubcells);
        const Vector2d middle((i % kSubcells + 0.5) / kSubcells, (i / kSubcells + 0.5) / kSubcells);
        points.subcells[k] = classify(crossed[k / (kSubcells * kSubcells)], middle, radius / kSubcells);
    });
}

/// A point on the rectangle's far edge belongs to the last cell.
std::int32_t cell_at(double u, std::int32_t cells) { return std::min(static_cast<std::int32_t>(u), cells - 1); }

/// Classifies a point in a cell that edges cross. @param u, v  from the cell's corner, in cells  @param w  W
DensePoints::Cell classify_point(const DensePoints& points, std::int32_t cell, double u, double v, const Vector2d& w)
{
    constexpr int kSubcells = DensePoints::kSubcells;
    const std::int32_t row = cell_at(kSubcells * u, kSubcells), column = cell_at(kSubcells * v, kSubcells);
    const DensePoints::Cell kind = points.subcells[points.first_subcell[cell] + kSubcells * column + row];
    if (kind <= DensePoints::drop_outside) return kind;
    const job::Boundaries& region = points.region;
    if (kind != DensePoints::edge_of_sampling && job::contains(region.anomaly, w)) return DensePoints::drop_anomaly;
    if (kind != DensePoints::edge_of_anomaly && !job::contains(region.sampling, w)) return DensePoints::drop_outside;
    return DensePoints::take;
}

} // namespace

PointCounts& PointCounts::operator+=(const PointCounts& other)
{
    undefined += other.undefined;
    other_role += other.other_role;
    anomaly += other.anomaly;
    outside += other.outside;
    overhang += other.overhang;
    used += other.used;
    return *this;
}

Vector2d machine_from_grid(const surface::Bspline& grid, const Vector2d& uv)
{
    return grid.origin + Eigen::Rotation2Dd(grid.angle) * uv.cwiseProduct(grid.cell);
}

DensePoints dense_points(const cloud::PointSource& source, const job::Job& job, const PointFilter& filter,
                         const std::string& name)
{
    DensePoints points{source, filter, {}, {}, {}, {}, {}, 0};
    if (filter.by_place || !source.has_roles) points.region = job::working_boundaries(job);
    const Eigen::Matrix2d rotation = job::rotation_working_machine(job.theta);
    const Extent extent = measure_extent(points, rotation, rotation * job.anomaly.topRows<2>().rowwise().mean());
    check_extent(extent, job, name, source.points);
    points.grid = grid_over(extent, job, rotation);
    classify_cells(points, rotation);
    points.max_abs_coordinate = extent.max_abs_coordinate;
    return points;
}

void assign_cells(const DensePoints& points, const cloud::PointBlock& block, std::vector<CellPoint>& used,
                  PointCounts& counts)
{
    used.clear();
    const surface::Bspline& grid = points.grid;
    const auto cells_u = static_cast<std::int32_t>(grid.heights.rows() - 3);
    const auto cells_v = static_cast<std::int32_t>(grid.heights.cols() - 3);
    const double c = std::cos(grid.angle), s = std::sin(grid.angle);
    const double u_x = c / grid.cell.x(), u_y = s / grid.cell.x(), v_x = -s / grid.cell.y(), v_y = c / grid.cell.y();
    const double* p = block.xyz.data();
    for (Index i = 0; i < block.xyz.cols(); ++i, p += 3) {
        if (points.source.has_roles && !is_used_role(block.roles[i], kSampleRoles, points.filter.use_boundary)) {
            ++counts.other_role;
            continue;
        }
        if (!std::isfinite(p[0] + p[1] + p[2])) {
            ++counts.undefined;
            continue;
        }
        if (is_overhang(block, i)) {
            ++counts.overhang;
            continue;
        }
        const double dx = p[0] - grid.origin.x(), dy = p[1] - grid.origin.y();
        const double u = u_x * dx + u_y * dy, v = v_x * dx + v_y * dy;
        if (!(u >= 0 && v >= 0 && u <= cells_u && v <= cells_v)) {
            ++counts.outside;
            continue;
        }
        const std::int32_t row = cell_at(u, cells_u), column = cell_at(v, cells_v);
        const std::int32_t cell = column * cells_u + row;
        DensePoints::Cell kind = points.cells[cell];
        if (kind > DensePoints::drop_outside)
            kind = classify_point(points, cell, u - row, v - column, {c * p[0] + s * p[1], c * p[1] - s * p[0]});
        if (kind == DensePoints::take)
            used.push_back({cell, u - row - 0.5, v - column - 0.5, p[2]});
        else
            ++(kind == DensePoints::drop_anomaly ? counts.anomaly : counts.outside);
    }
    counts.used += used.size();
}

std::vector<CellPoint> regrid(const std::vector<CellPoint>& points, const surface::Bspline& from,
                              const surface::Bspline& to)
{
    const auto old_u = static_cast<std::int32_t>(from.heights.rows() - 3);
    const auto cells_u = static_cast<std::int32_t>(to.heights.rows() - 3);
    const auto cells_v = static_cast<std::int32_t>(to.heights.cols() - 3);
    const Vector2d ratio = from.cell.cwiseQuotient(to.cell);
    std::vector<CellPoint> moved;
    moved.reserve(points.size());
    for (const CellPoint& p : points) {
        const double u = (p.cell % old_u + 0.5 + p.u) * ratio.x(), v = (p.cell / old_u + 0.5 + p.v) * ratio.y();
        const std::int32_t row = cell_at(u, cells_u), column = cell_at(v, cells_v);
        moved.push_back({column * cells_u + row, u - row - 0.5, v - column - 0.5, p.z});
    }
    return moved;
}

} // namespace fettle::fit
