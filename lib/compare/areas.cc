#include "compare/areas.h"

#include <Eigen/Dense>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace fettle::compare {

namespace {

constexpr double kPointsPerBin = 16;

constexpr double kMinNormalZ = 0.1; // smallest |n_z| for which a plan area determines the surface area: 84°

// Largest distance, in cells, of a lattice point from its ideal position. Rounding to float stays far below.
constexpr double kLatticeToleranceCells = 0.1;
// The first estimate of the cell, from two neighbours, is good to about 1e-3. Up to this many cells away it still
// rounds points to the right lattice position.
constexpr double kFirstFitRadiusCells = 50;

/// Lattice p = origin + i a + j b with integers i and j.
struct Lattice {
    Eigen::Vector2d origin, a, b;
    Eigen::Matrix2d cell() const { return (Eigen::Matrix2d() << a, b).finished(); }
};

/// Accumulates the finite points of each block into a result of its own, in parallel. Returns the results in the order
/// of the blocks.
template <typename Result, typename Accumulate>
std::vector<Result> map_blocks(const cloud::PointSource& points, const Accumulate& accumulate)
{
    std::vector<Result> results(points.block_count());
    cloud::for_each_block(points, [&](std::size_t b, const cloud::PointBlock& block) {
        for (const auto& point : block.xyz.colwise())
            if (point.allFinite()) accumulate(results[b], Eigen::Vector2d(point.head<2>()));
    });
    return results;
}

std::optional<Eigen::Vector2d> first_finite_point(const cloud::PointSource& points)
{
    cloud::PointBlock block;
    for (std::size_t first = 0; first < points.points; first += points.block_size) {
        points.read(first, std::min(points.block_size, points.points - first), block);
        for (const auto& point : block.xyz.colwise())
            if (point.allFinite()) return point.head<2>();
    }
    return std::nullopt;
}

struct ShortestStep {
    Eigen::Vector2d step = {0, 0}; ///< zero: none yet

    void include(const Eigen::Vector2d& other)
    {
        if (!other.isZero(0) && (step.isZero(0) || other.squaredNorm() < step.squaredNorm())) step = other;
    }
};

struct Extent {
    Eigen::AlignedBox2d box;
    std::size_t finite_points = 0;
    ShortestStep shortest; ///< from the first point to another
};

Extent extent_of(const cloud::PointSource& points, const Eigen::Vector2d& first)
{
    const auto parts = map_blocks<Extent>(points, [&](Extent& extent, const Eigen::Vector2d& p) {
        ++extent.finite_points;
        extent.box.extend(p);
        extent.shortest.include(p - first);
    });
    Extent all;
    for (const Extent& part : parts) {
        all.finite_points += part.finite_points;
        all.box.extend(part.box);
        all.shortest.include(part.shortest.step);
    }
    return all;
}

/// The shortest step from `from` to another point that is perpendicular to `a`; zero if there is none.
Eigen::Vector2d shortest_perpendicular(const cloud::PointSource& points, const Eigen::Vector2d& from,
                                       const Eigen::Vector2d& a)
{
    const auto parts = map_blocks<ShortestStep>(points, [&](ShortestStep& shortest, const Eigen::Vector2d& p) {
        const Eigen::Vector2d step = p - from;
        if (std::abs(step.dot(a)) < kLatticeToleranceCells * a.norm() * step.norm()) shortest.include(step);
    });
    ShortestStep best;
    for (const ShortestStep& part : parts) best.include(part.step);
    return best.step;
}

// First estimate: the shortest step from the first point to another, and the shortest one perpendicular to it.
std::optional<Lattice> guess_lattice(const cloud::PointSource& points, const Eigen::Vector2d& first,
                                     const Eigen::Vector2d& step)
{
    if (step.isZero(0)) return std::nullopt;
    const Eigen::Vector2d perpendicular = shortest_perpendicular(points, first, step);
    if (perpendicular.isZero(0)) return std::nullopt;
    return Lattice{first, step, perpendicular};
}

struct PlaneEquations {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> B = Eigen::Matrix<double, 3, 2>::Zero();
};

// Least squares fit to the points within `radius` cells of the origin; nothing if one of them is off the lattice.
std::optional<Lattice> refine(const cloud::PointSource& points, const Lattice& lattice, double radius)
{
    const Eigen::Matrix2d to_cells = lattice.cell().inverse();
    std::atomic<bool> off_lattice = false; // the other threads may stop then
    const auto parts = map_blocks<PlaneEquations>(points, [&](PlaneEquations& sums, const Eigen::Vector2d& p) {
        if (off_lattice.load(std::memory_order_relaxed)) return;
        const Eigen::Vector2d cells = to_cells * (p - lattice.origin);
        if (cells.cwiseAbs().maxCoeff() > radius) return;
        const Eigen::Vector2d ij = cells.array().round();
        if ((cells - ij).cwiseAbs().maxCoeff() > kLatticeToleranceCells) off_lattice = true;
        const Eigen::Vector3d row(1, ij.x(), ij.y());
        sums.A += row * row.transpose();
        sums.B += row * (p - lattice.origin).transpose();
    });
    if (off_lattice) return std::nullopt;
    PlaneEquations all;
    for (const PlaneEquations& part : parts) {
        all.A += part.A;
        all.B += part.B;
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> solver(all.A);
    if (!solver.isInvertible()) return std::nullopt;
    const Eigen::Matrix<double, 3, 2> fit = solver.solve(all.B);
    return Lattice{lattice.origin + fit.row(0).transpose(), fit.row(1).transpose(), fit.row(2).transpose()};
}

} // namespace

Eigen::VectorXd vertex_areas(const mesh::Mesh& mesh, const Eigen::Vector3d& direction)
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

Eigen::VectorXd vertex_areas(const mesh::Mesh& mesh) { return vertex_areas(mesh, Eigen::Vector3d::Zero()); }

PlanAreas::PlanAreas(const cloud::PointSource& points)
{
    const std::optional<Eigen::Vector2d> first = first_finite_point(points);
    if (!first) return;
    const Extent extent = extent_of(points, *first);
    if (extent.finite_points < 2) return;
    std::optional<Lattice> lattice;
    if (extent.finite_points >= 4) lattice = guess_lattice(points, *first, extent.shortest.step);
    for (const double radius : {kFirstFitRadiusCells, std::numeric_limits<double>::infinity()})
        if (lattice) lattice = refine(points, *lattice, radius);
    if (lattice) {
        cell_ = std::abs(lattice->cell().determinant());
        return;
    }
    const Eigen::Array2d sizes = extent.box.sizes();
    const double count = extent.finite_points;
    // A strip narrower than its bins gets bins of its own width; no axis is divided finer than there are points.
    const double square = std::max(std::sqrt(kPointsPerBin * sizes.prod() / count), sizes.maxCoeff() / count);
    min_ = extent.box.min();
    bin_size_ = sizes.min(square);
    if (!(bin_size_.minCoeff() > 0)) return; // all on one line: no area
    bins_ = (sizes / bin_size_).cast<Eigen::Index>() + 1;
    counts_.assign(bins_.prod(), 0);
    cloud::for_each_block(points, [&](std::size_t, const cloud::PointBlock& block) {
        for (const auto& point : block.xyz.colwise())
            if (point.allFinite())
                std::atomic_ref(counts_[bin(point.head<2>())]).fetch_add(1, std::memory_order_relaxed);
    });
}

Eigen::Index PlanAreas::bin(const Eigen::Vector2d& xy) const
{
    const Eigen::Array<Eigen::Index, 2, 1> ij = ((xy.array() - min_) / bin_size_).cast<Eigen::Index>();
    return ij.y() * bins_.x() + ij.x();
}

Eigen::VectorXd PlanAreas::operator()(const Eigen::Matrix3Xd& xyz) const
{
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(xyz.cols());
    for (Eigen::Index i = 0; i < areas.size(); ++i) {
        if (!xyz.col(i).allFinite()) continue;
        if (cell_ > 0)
            areas[i] = cell_;
        else if (!counts_.empty())
            areas[i] = bin_size_.prod() / counts_[bin(xyz.col(i).head<2>())];
    }
    return areas;
}

Eigen::VectorXd volume_weights(const Eigen::VectorXd& plan_areas, const ErrorMap& map, const DistanceOptions& options)
{
    Eigen::VectorXd weights = plan_areas;
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
        const double normal_z = std::abs(map.normal(2, i));
        const double projection =
            options.mode == DistanceMode::direction ? std::abs(map.normal.col(i).dot(options.direction)) : 1;
        weights[i] *= normal_z >= kMinNormalZ ? projection / normal_z : 0;
    }
    return weights;
}

Eigen::VectorXd volume_weights(const mesh::Mesh& mesh, const DistanceOptions& options)
{
    return options.mode == DistanceMode::direction ? vertex_areas(mesh, options.direction) : vertex_areas(mesh);
}

} // namespace fettle::compare
