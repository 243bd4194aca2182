#include "fit/dense_points.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/text.h"
#include "fit/fit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kMostRole = 5;
constexpr std::size_t kLeastPoints = 6; // of a quadratic

// Two cells for each point along a side, as far as factorising their equations takes no longer than reading the points:
// its cost goes with the fourth power of the cells on a side.
constexpr double kLeastCells = 12;
constexpr double kMostCells = 64;
// Share of the longer side that the grid goes beyond the points, on either side: room for the wheel's footprint.
constexpr double kAround = 1 / 12.0;

/// Where the points lie, W.
struct Extent {
    Vector2d least = Vector2d::Constant(kInfinite), most = Vector2d::Constant(-kInfinite);
    Vector2d sum = Vector2d::Zero(); ///< from the middle of B
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    double largest = 0;
    std::size_t count = 0;
    std::size_t bad_role = std::numeric_limits<std::size_t>::max(); ///< first point
    double role = 0;                                                ///< of it

    void add(const Extent& other)
    {
        least = least.cwiseMin(other.least);
        most = most.cwiseMax(other.most);
        sum += other.sum;
        squares += other.squares;
        largest = std::max(largest, other.largest);
        count += other.count;
        if (other.bad_role < bad_role) std::tie(bad_role, role) = std::pair(other.bad_role, other.role);
    }
};

bool finite(const Eigen::Vector3d& p) { return std::isfinite(p.x() + p.y() + p.z()); }

bool wanted(double role, bool use_boundary)
{
    return (role == 0 && use_boundary) ||
           std::find(kSampleRoles.begin(), kSampleRoles.end(), role) != kSampleRoles.end();
}

Extent extent_of(const DensePoints& points, const Eigen::Matrix2d& rotation, const Vector2d& middle)
{
    const bool bounded = points.region.sampling.cols() > 0;
    Vector2d low = Vector2d::Constant(-kInfinite), high = Vector2d::Constant(kInfinite);
    if (bounded) {
        low = points.region.sampling.rowwise().minCoeff();
        high = points.region.sampling.rowwise().maxCoeff();
    }
    std::array<Extent, kBlockLanes> lanes;
    for_blocks(points.source, [&](std::size_t lane, std::size_t first, const PointBlock& block) {
        Extent& e = lanes[lane];
        for (Index i = 0; i < block.xyz.cols(); ++i) {
            if (points.source.has_roles) {
                const double role = block.roles[i];
                if (!(role >= 0 && role <= kMostRole && role == std::floor(role)) &&
                    first + static_cast<std::size_t>(i) < e.bad_role)
                    std::tie(e.bad_role, e.role) = std::pair(first + static_cast<std::size_t>(i), role);
                if (!wanted(role, points.use_boundary)) continue;
            }
            const Eigen::Vector3d p = block.xyz.col(i);
            if (!finite(p)) continue;
            const Vector2d w = rotation * p.head<2>();
            if (!((w.array() >= low.array()).all() && (w.array() <= high.array()).all())) continue;
            e.least = e.least.cwiseMin(w);
            e.most = e.most.cwiseMax(w);
            const Vector2d d = w - middle;
            e.sum += d;
            e.squares += d * d.transpose();
            e.largest = std::max(e.largest, p.cwiseAbs().maxCoeff());
            ++e.count;
        }
    });
    for (std::size_t lane = 1; lane < kBlockLanes; ++lane) lanes[0].add(lanes[lane]);
    return lanes[0];
}

void refuse_few(const Extent& extent, const Job& job, const std::string& name, std::size_t all)
{
    if (extent.count < kLeastPoints)
        throw InputError(name, "a bspline fit needs at least " + std::to_string(kLeastPoints) + " touches, got " +
                                   std::to_string(extent.count) + " of " + std::to_string(all) +
                                   " points that it may use");
    const double n = static_cast<double>(extent.count);
    const Vector2d mean = extent.sum / n;
    const SymmetricEigen<2> spread = symmetric_eigen<2>(extent.squares / n - mean * mean.transpose());
    if (std::sqrt(std::max(spread.values[0], 0.0)) <= job.probe.accuracy)
        throw InputError(name, "touches lie on one line in x and y");
}

Bspline grid_over(const Extent& extent, const Job& job, const Eigen::Matrix2d& rotation)
{
    const Eigen::Matrix2Xd anomaly = rotation * job.anomaly.topRows<2>();
    const Vector2d least = extent.least.cwiseMin(anomaly.rowwise().minCoeff());
    const Vector2d side = extent.most.cwiseMax(anomaly.rowwise().maxCoeff()) - least;
    const double cells =
        std::clamp(std::ceil(2 * std::sqrt(static_cast<double>(extent.count))), kLeastCells, kMostCells);
    const double around = std::ceil(cells * kAround / (1 + 2 * kAround));
    const double cell = side.maxCoeff() / (cells - 2 * around);
    const Vector2d counts = (side / cell).array().round().max(2);
    Bspline grid;
    grid.angle = job.theta;
    grid.cell = side.cwiseQuotient(counts);
    grid.origin = rotation.transpose() * (least - around * grid.cell);
    const Eigen::Array2i all = (counts.array() + 2 * around).cast<int>() + 3; // a cubic's functions are three more
    grid.heights.setZero(all.x(), all.y());
    return grid;
}

/// Of the points within `reach` of a place. @param w  W
DensePoints::Cell kind_about(const Boundaries& region, const Vector2d& w, double reach)
{
    const Polygon& B = region.anomaly;
    const Polygon& S = region.sampling;
    const bool anomaly_near = distance_to_edge(B, w) <= reach;
    const bool sampling_near = S.cols() > 0 && distance_to_edge(S, w) <= reach;
    if (anomaly_near && sampling_near) return DensePoints::edge_of_both;
    if (!anomaly_near && contains(B, w)) return DensePoints::drop_anomaly;
    if (!sampling_near && S.cols() > 0 && !contains(S, w)) return DensePoints::drop_outside;
    if (anomaly_near) return DensePoints::edge_of_anomaly;
    return sampling_near ? DensePoints::edge_of_sampling : DensePoints::take;
}

/// Whole cells by their middles, as far as no edge comes near; parts of the others likewise.
void classify(DensePoints& points, const Eigen::Matrix2d& rotation)
{
    constexpr int kParts = DensePoints::kParts;
    const Index cells_u = points.grid.heights.rows() - 3, cells_v = points.grid.heights.cols() - 3;
    points.cells.assign(static_cast<std::size_t>(cells_u * cells_v), DensePoints::take);
    points.first_part.assign(points.cells.size(), -1);
    if (points.region.anomaly.cols() == 0) return;
    const double reach = points.grid.cell.norm() / 2;
    const auto kind = [&](std::size_t cell, const Vector2d& inside, double near) {
        const auto k = static_cast<Index>(cell);
        const Vector2d corner(static_cast<double>(k % cells_u), static_cast<double>(k / cells_u));
        return kind_about(points.region, rotation * place_in(points.grid, corner + inside), near);
    };
    tbb::parallel_for(std::size_t{0}, points.cells.size(), [&](std::size_t k) {
        points.cells[k] = kind(k, {0.5, 0.5}, reach);
    });
    std::vector<std::size_t> crossed;
    for (std::size_t k = 0; k < points.cells.size(); ++k) {
        if (points.cells[k] <= DensePoints::drop_outside) continue;
        points.first_part[k] = static_cast<std::int32_t>(kParts * kParts * crossed.size());
        crossed.push_back(k);
    }
    points.parts.resize(kParts * kParts * crossed.size());
    tbb::parallel_for(std::size_t{0}, points.parts.size(), [&](std::size_t part) {
        const auto i = static_cast<int>(part % (kParts * kParts));
        const Vector2d middle((i % kParts + 0.5) / kParts, (i / kParts + 0.5) / kParts);
        points.parts[part] = kind(crossed[part / (kParts * kParts)], middle, reach / kParts);
    });
}

/// A point on the rectangle's far edge belongs to the last cell.
std::int32_t cell_at(double u, std::int32_t cells) { return std::min(static_cast<std::int32_t>(u), cells - 1); }

/// Of a point in a cell that edges cross. @param u, v  from the cell's corner, in cells  @param w  W
DensePoints::Cell kind_of(const DensePoints& points, std::int32_t cell, double u, double v, const Vector2d& w)
{
    constexpr int kParts = DensePoints::kParts;
    const std::int32_t row = cell_at(kParts * u, kParts), column = cell_at(kParts * v, kParts);
    const std::int32_t part = points.first_part[static_cast<std::size_t>(cell)] + kParts * column + row;
    const DensePoints::Cell kind = points.parts[static_cast<std::size_t>(part)];
    if (kind <= DensePoints::drop_outside) return kind;
    const Boundaries& region = points.region;
    const bool by_anomaly = kind == DensePoints::edge_of_anomaly || kind == DensePoints::edge_of_both;
    const bool by_sampling = kind == DensePoints::edge_of_sampling || kind == DensePoints::edge_of_both;
    if (by_anomaly && contains(region.anomaly, w)) return DensePoints::drop_anomaly;
    if (by_sampling && !contains(region.sampling, w)) return DensePoints::drop_outside;
    return DensePoints::take;
}

} // namespace

PointCounts& PointCounts::operator+=(const PointCounts& other)
{
    undefined += other.undefined;
    other_role += other.other_role;
    anomaly += other.anomaly;
    outside += other.outside;
    used += other.used;
    return *this;
}

Vector2d place_in(const Bspline& grid, const Vector2d& uv)
{
    return grid.origin + Eigen::Rotation2Dd(grid.angle) * uv.cwiseProduct(grid.cell);
}

DensePoints dense_points(const PointSource& source, const Job& job, bool use_boundary, const std::string& name)
{
    DensePoints points{source, use_boundary, {}, {}, {}, {}, {}, 0};
    if (!source.has_roles) points.region = boundaries(job);
    const Eigen::Matrix2d rotation = rotation_working_machine(job.theta);
    const Extent extent = extent_of(points, rotation, rotation * job.anomaly.topRows<2>().rowwise().mean());
    if (extent.bad_role < source.points)
        throw InputError(name, "point " + std::to_string(extent.bad_role) + ": " + to_text(extent.role) +
                                   " is no role (0 to 5)");
    refuse_few(extent, job, name, source.points);
    points.grid = grid_over(extent, job, rotation);
    classify(points, rotation);
    points.largest = extent.largest;
    return points;
}

void locate(const DensePoints& points, const PointBlock& block, std::vector<CellPoint>& into, PointCounts& counts)
{
    into.clear();
    const Bspline& grid = points.grid;
    const auto cells_u = static_cast<std::int32_t>(grid.heights.rows() - 3);
    const auto cells_v = static_cast<std::int32_t>(grid.heights.cols() - 3);
    const double c = std::cos(grid.angle), s = std::sin(grid.angle);
    const double u_x = c / grid.cell.x(), u_y = s / grid.cell.x(), v_x = -s / grid.cell.y(), v_y = c / grid.cell.y();
    const double* p = block.xyz.data();
    for (Index i = 0; i < block.xyz.cols(); ++i, p += 3) {
        if (points.source.has_roles && !wanted(block.roles[i], points.use_boundary)) {
            ++counts.other_role;
            continue;
        }
        if (!std::isfinite(p[0] + p[1] + p[2])) {
            ++counts.undefined;
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
        DensePoints::Cell kind = points.cells[static_cast<std::size_t>(cell)];
        if (kind > DensePoints::drop_outside)
            kind = kind_of(points, cell, u - row, v - column, {c * p[0] + s * p[1], c * p[1] - s * p[0]});
        if (kind == DensePoints::take)
            into.push_back({cell, u - row - 0.5, v - column - 0.5, p[2]});
        else
            ++(kind == DensePoints::drop_anomaly ? counts.anomaly : counts.outside);
    }
    counts.used += into.size();
}

void relocate(const std::vector<CellPoint>& points, const Bspline& from, const Bspline& to,
              std::vector<CellPoint>& into)
{
    const auto old_u = static_cast<std::int32_t>(from.heights.rows() - 3);
    const auto cells_u = static_cast<std::int32_t>(to.heights.rows() - 3);
    const auto cells_v = static_cast<std::int32_t>(to.heights.cols() - 3);
    const Vector2d ratio = from.cell.cwiseQuotient(to.cell);
    into.clear();
    for (const CellPoint& p : points) {
        const double u = (p.cell % old_u + 0.5 + p.u) * ratio.x(), v = (p.cell / old_u + 0.5 + p.v) * ratio.y();
        const std::int32_t row = cell_at(u, cells_u), column = cell_at(v, cells_v);
        into.push_back({column * cells_u + row, u - row - 0.5, v - column - 0.5, p.z});
    }
}

} // namespace fettle
