#include "compare/areas.h"

#include <Eigen/Dense>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace fettle {

namespace {

constexpr double kPointsPerSquare = 16;

constexpr double kSteepest = 0.1; // least |n_z| for which an area seen from above tells that of the surface: 84°

// A point further than this from its lattice place, in cells, is not on the lattice. Rounding to float stays far below.
constexpr double kOffLattice = 0.1;
// The first estimate of the cell, from two neighbours, is good to about 1e-3: over so many cells it still tells places.
constexpr double kFirstReach = 50;

/// p = origin + i a + j b
struct Lattice {
    Eigen::Vector2d origin, a, b;
    Eigen::Matrix2d cell() const { return (Eigen::Matrix2d() << a, b).finished(); }
};

/// What the finite points of each block tell, in the order of the blocks.
template <typename Told, typename Tell>
std::vector<Told> of_blocks(const PointSource& points, const Tell& tell)
{
    std::vector<Told> told(points.blocks());
    for_each_block(points, [&](std::size_t b, const PointBlock& block) {
        for (const auto& point : block.xyz.colwise())
            if (point.allFinite()) tell(told[b], Eigen::Vector2d(point.head<2>()));
    });
    return told;
}

/// The first finite point.
std::optional<Eigen::Vector2d> first_point(const PointSource& points)
{
    PointBlock block;
    for (std::size_t first = 0; first < points.points; first += points.block) {
        points.read(first, std::min(points.block, points.points - first), block);
        for (const auto& point : block.xyz.colwise())
            if (point.allFinite()) return point.head<2>();
    }
    return std::nullopt;
}

/// A step from one point to another; zero: none yet.
void shorten(Eigen::Vector2d& best, const Eigen::Vector2d& step)
{
    if (step.isZero(0)) return;
    if (best.isZero(0) || step.squaredNorm() < best.squaredNorm()) best = step;
}

struct Extent {
    Eigen::AlignedBox2d box;
    std::size_t finite = 0;
    Eigen::Vector2d step = {0, 0}; ///< the shortest from the first point to another
};

Extent extent_of(const PointSource& points, const Eigen::Vector2d& first)
{
    Extent all;
    for (const Extent& part : of_blocks<Extent>(points, [&](Extent&extent, const Eigen::Vector2d&p) {
             ++extent.finite;
             extent.box.extend(p);
             shorten(extent.step, p - first);
         })) {
        all.finite += part.finite;
        all.box.extend(part.box);
        shorten(all.step, part.step);
    }
    return all;
}

/// The shortest step from `from` to another point that is across `a`; none: zero.
Eigen::Vector2d shortest_across(const PointSource& points, const Eigen::Vector2d& from, const Eigen::Vector2d& a)
{
    struct Step {
        Eigen::Vector2d step = {0, 0};
    };
    Eigen::Vector2d best = {0, 0};
    for (const Step& part : of_blocks<Step>(points, [&](Step&shortest, const Eigen::Vector2d&p) {
             const Eigen::Vector2d step = p - from;
             if (std::abs(step.dot(a)) < kOffLattice * a.norm() * step.norm()) shorten(shortest.step, step);
         }))
        shorten(best, part.step);
    return best;
}

// The shortest step from the first point to another, and the shortest one across it.
std::optional<Lattice> guess(const PointSource& points, const Eigen::Vector2d& first, const Eigen::Vector2d& step)
{
    if (step.isZero(0)) return std::nullopt;
    const Eigen::Vector2d across = shortest_across(points, first, step);
    if (across.isZero(0)) return std::nullopt;
    return Lattice{first, step, across};
}

/// Normal equations of a lattice, of the points that lie on it.
struct LatticeSums {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> B = Eigen::Matrix<double, 3, 2>::Zero();
};

// Least squares of the points within `reach` cells; nothing if one of them is off its place.
std::optional<Lattice> refine(const PointSource& points, const Lattice& lattice, double reach)
{
    const Eigen::Matrix2d to_cells = lattice.cell().inverse();
    std::atomic<bool> off = false; // then all others need not look
    const auto parts = of_blocks<LatticeSums>(points, [&](LatticeSums& sums, const Eigen::Vector2d& p) {
        if (off.load(std::memory_order_relaxed)) return;
        const Eigen::Vector2d cells = to_cells * (p - lattice.origin);
        if (cells.cwiseAbs().maxCoeff() > reach) return;
        const Eigen::Vector2d place = cells.array().round();
        if ((cells - place).cwiseAbs().maxCoeff() > kOffLattice) off = true;
        const Eigen::Vector3d row(1, place.x(), place.y());
        sums.A += row * row.transpose();
        sums.B += row * (p - lattice.origin).transpose();
    });
    if (off) return std::nullopt;
    LatticeSums all;
    for (const LatticeSums& part : parts) {
        all.A += part.A;
        all.B += part.B;
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> solver(all.A);
    if (!solver.isInvertible()) return std::nullopt;
    const Eigen::Matrix<double, 3, 2> fit = solver.solve(all.B);
    return Lattice{lattice.origin + fit.row(0).transpose(), fit.row(1).transpose(), fit.row(2).transpose()};
}

} // namespace

Eigen::VectorXd vertex_areas(const Mesh& mesh, const Eigen::Vector3d& direction)
{
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.vertices.cols());
    for (const Eigen::Vector3i corners : mesh.triangles.colwise()) {
        const Eigen::Vector3d p = mesh.vertices.col(corners[0]);
        const Eigen::Vector3d q = mesh.vertices.col(corners[1]), r = mesh.vertices.col(corners[2]);
        const Eigen::Vector3d twice = (q - p).cross(r - p);
        const double area = (direction.isZero(0) ? twice.norm() : std::abs(twice.dot(direction))) / 2;
        for (const int corner : corners) areas[corner] += area / 3;
    }
    return areas;
}

Eigen::VectorXd vertex_areas(const Mesh& mesh) { return vertex_areas(mesh, Eigen::Vector3d::Zero()); }

PlanAreas::PlanAreas(const PointSource& points)
{
    const std::optional<Eigen::Vector2d> first = first_point(points);
    if (!first) return;
    const Extent extent = extent_of(points, *first);
    if (extent.finite < 2) return;
    std::optional<Lattice> lattice = extent.finite < 4 ? std::nullopt : guess(points, *first, extent.step);
    for (const double reach : {kFirstReach, std::numeric_limits<double>::infinity()})
        if (lattice) lattice = refine(points, *lattice, reach);
    if (lattice) {
        cell_ = std::abs(lattice->cell().determinant());
        return;
    }
    const Eigen::Array2d sizes = extent.box.sizes();
    const auto count = static_cast<double>(extent.finite);
    // Of a strip narrower than its squares no more than its width; no axis is cut finer than there are points.
    const double square = std::max(std::sqrt(kPointsPerSquare * sizes.prod() / count), sizes.maxCoeff() / count);
    least_ = extent.box.min();
    side_ = sizes.min(square);
    if (!(side_.minCoeff() > 0)) return; // all on one line: no area
    bins_ = (sizes / side_).cast<Eigen::Index>() + 1;
    counts_.assign(static_cast<std::size_t>(bins_.prod()), 0);
    for_each_block(points, [&](std::size_t, const PointBlock& block) {
        for (const auto& point : block.xyz.colwise())
            if (point.allFinite())
                std::atomic_ref(counts_[static_cast<std::size_t>(bin(point.head<2>()))])
                    .fetch_add(1, std::memory_order_relaxed);
    });
}

Eigen::Index PlanAreas::bin(const Eigen::Vector2d& xy) const
{
    const Eigen::Array<Eigen::Index, 2, 1> place = ((xy.array() - least_) / side_).cast<Eigen::Index>();
    return place.y() * bins_.x() + place.x();
}

Eigen::VectorXd PlanAreas::operator()(const Eigen::Matrix3Xd& xyz) const
{
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(xyz.cols());
    for (Eigen::Index i = 0; i < areas.size(); ++i) {
        if (!xyz.col(i).allFinite()) continue;
        if (cell_ > 0)
            areas[i] = cell_;
        else if (!counts_.empty())
            areas[i] = side_.prod() / counts_[static_cast<std::size_t>(bin(xyz.col(i).head<2>()))];
    }
    return areas;
}

Eigen::VectorXd volume_areas(const Eigen::VectorXd& plan_areas, const ErrorMap& map, const DistanceOptions& options)
{
    Eigen::VectorXd areas = plan_areas;
    for (Eigen::Index i = 0; i < areas.size(); ++i) {
        const double steepness = std::abs(map.normal(2, i));
        const double seen =
            options.mode == DistanceMode::direction ? std::abs(map.normal.col(i).dot(options.direction)) : 1;
        areas[i] *= steepness >= kSteepest ? seen / steepness : 0;
    }
    return areas;
}

Eigen::VectorXd volume_areas(const Mesh& mesh, const DistanceOptions& options)
{
    return options.mode == DistanceMode::direction ? vertex_areas(mesh, options.direction) : vertex_areas(mesh);
}

} // namespace fettle
