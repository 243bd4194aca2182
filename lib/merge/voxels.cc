#include "merge/voxels.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "geometry/bounding_box.h"
#include "geometry/orientation.h"
#include "geometry/point_index.h"
#include "geometry/quantiles.h"

#include <Eigen/Dense>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <ranges>
#include <utility>

namespace fettle::merge {
namespace {

constexpr int kKeyBits = 21;           // three of them fill a key of 64 bits
constexpr double kMaxVoxels = 1 << 20; // along an axis

// A plane needs three points, and its direction and standard deviation some more.
constexpr double kMinPlanePoints = 6, kMinNoisePoints = 5;

std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z)
{
    return static_cast<std::uint64_t>(z) << 2 * kKeyBits | static_cast<std::uint64_t>(y) << kKeyBits |
           static_cast<std::uint64_t>(x);
}

/// Sums over points, from which their plane follows. Offsets are from the cube's own mean or a place nearby.
struct Moments {
    double count = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero(); ///< Σ (p - mean)(p - mean)ᵀ

    /// Makes these the moments of both sets together (Chan, Golub & LeVeque, Updating formulae for computing sample
    /// variances, 1979).
    void add(const Moments& other)
    {
        const Eigen::Vector3d between = other.mean - mean;
        const double sum = count + other.count;
        scatter += other.scatter + count * other.count / sum * between * between.transpose();
        mean += other.count / sum * between;
        count = sum;
    }
};

Moments moments_of(const Eigen::Matrix3Xd& xyz, std::span<const std::uint32_t> points)
{
    Moments m;
    m.count = static_cast<double>(points.size());
    for (const std::uint32_t i : points) m.mean += xyz.col(i);
    m.mean /= m.count;
    for (const std::uint32_t i : points)
        m.scatter.noalias() += (xyz.col(i) - m.mean) * (xyz.col(i) - m.mean).transpose();
    return m;
}

/// A cube and what is around it.
struct Cell {
    Moments moments;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::vector<std::uint32_t> neighbours;
};

/// Standard deviation of the points from the planes of their own cubes: median over the cubes.
double noise_of(const std::vector<Cell>& cells)
{
    std::vector<double> variances;
    for (const auto& [m, normal, neighbours] : cells) {
        if (m.count < kMinNoisePoints) continue;
        const double freedom = m.count - 3;
        const double median_over_mean = std::pow(1 - 2 / (9 * freedom), 3); // of chi-squared (Wilson & Hilferty 1931)
        const double squares = std::max(0.0, core::symmetric_eigen<3>(m.scatter).values[0]);
        variances.push_back(squares / (freedom * median_over_mean));
    }
    return variances.empty() ? 0 : std::sqrt(geometry::median(variances));
}

/// Planes through each cube and those around it.
void find_planes(std::vector<Cell>& cells, const VoxelGrid& grid)
{
    tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t v) {
        Cell& cell = cells[v];
        Moments local;
        for (const std::size_t other : grid.around(cell.moments.mean)) {
            local.add(cells[other].moments);
            if (other != v) cell.neighbours.push_back(static_cast<std::uint32_t>(other));
        }
        if (local.count < kMinPlanePoints) return;
        const core::SymmetricEigen<3> plane = core::symmetric_eigen<3>(local.scatter);
        constexpr double kMinWidthRatio = 0.05; // of a line of points to its length: a profile has no plane
        if (!(plane.values[1] > kMinWidthRatio * kMinWidthRatio * plane.values[2])) return;
        cell.normal = plane.vectors.col(0);
    });
}

/// Where a face of the grid runs along the surface, noise divides the points between two cubes, and neither mean is the
/// surface's: the smaller one is joined to the larger. @return  for each cube the one that has its points
std::vector<std::size_t> join_layers(std::vector<Cell>& cells, double noise, double length)
{
    constexpr double kMaxLayerSidewaysLengths = 0.5, kMaxOffsetSigmas = 6;
    std::vector<std::size_t> order(cells.size()), target(cells.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    target = order;
    const auto rank = [&](std::size_t v) { return std::pair(cells[v].moments.count, -static_cast<double>(v)); };
    std::vector<std::pair<double, double>> ranks(cells.size());
    for (std::size_t v = 0; v < cells.size(); ++v) ranks[v] = rank(v);
    std::ranges::sort(order, {}, [&](std::size_t v) { return ranks[v]; });
    for (const std::size_t v : order) {
        const Cell& cell = cells[v];
        if (cell.normal.isZero(0)) continue;
        for (const std::uint32_t other : cell.neighbours) {
            if (ranks[other] < ranks[target[v]] || target[other] != other) continue;
            const Eigen::Vector3d between = cell.moments.mean - cells[other].moments.mean;
            const double offset = between.dot(cell.normal);
            if (std::abs(offset) < kMaxOffsetSigmas * noise &&
                (between - offset * cell.normal).norm() < kMaxLayerSidewaysLengths * length)
                target[v] = other;
        }
        if (target[v] != v) cells[target[v]].moments.add(cell.moments);
    }
    for (const std::size_t v : order | std::views::reverse)
        target[v] = target[target[v]]; // the larger ones are resolved
    return target;
}

} // namespace

VoxelGrid::VoxelGrid(const Eigen::Matrix3Xd& xyz, double length) : length_(length), order_(xyz.cols())
{
    const Eigen::AlignedBox3d box = geometry::bounding_box(xyz);
    if (!(box.sizes().maxCoeff() / length < kMaxVoxels))
        throw core::InputError("the points extend over more than 2^20 times their distance from each other");
    low_ = ((box.min().array() / length).floor() - 1) * length; // a margin: cubes beside the lowest have keys, too
    std::vector<std::pair<std::uint64_t, std::uint32_t>> entries(order_.size());
    tbb::parallel_for(std::size_t{0}, entries.size(), [&](std::size_t i) {
        const Eigen::Array<std::int64_t, 3, 1> cell =
            ((xyz.col(i).array() - low_) / length_).floor().cast<std::int64_t>();
        entries[i] = {key_of(cell[0], cell[1], cell[2]), static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i == 0 || entries[i].first != entries[i - 1].first) {
            keys_.push_back(entries[i].first);
            first_.push_back(i);
        }
        order_[i] = entries[i].second;
    }
    first_.push_back(entries.size());
}

std::vector<std::size_t> VoxelGrid::around(const Eigen::Vector3d& place) const
{
    std::vector<std::size_t> found;
    const Eigen::Array3d cell = ((place.array() - low_) / length_).floor();
    if (cell.minCoeff() < -1 || cell.maxCoeff() > kMaxVoxels + 2) return found;
    const Eigen::Array<std::int64_t, 3, 1> c = cell.cast<std::int64_t>();
    for (std::int64_t z = std::max<std::int64_t>(c[2] - 1, 0); z <= c[2] + 1; ++z)
        for (std::int64_t y = std::max<std::int64_t>(c[1] - 1, 0); y <= c[1] + 1; ++y) {
            const std::uint64_t last = key_of(c[0] + 1, y, z);
            auto at = std::ranges::lower_bound(keys_, key_of(std::max<std::int64_t>(c[0] - 1, 0), y, z));
            for (; at != keys_.end() && *at <= last; ++at)
                found.push_back(static_cast<std::size_t>(at - keys_.begin()));
        }
    return found;
}

VoxelMeans voxel_means(const Eigen::Matrix3Xd& xyz, const VoxelGrid& grid, const Sides& sides, double length)
{
    std::vector<Cell> cells(grid.size());
    tbb::parallel_for(std::size_t{0}, grid.size(),
                      [&](std::size_t v) { cells[v].moments = moments_of(xyz, grid.points(v)); });
    VoxelMeans means;
    means.noise = noise_of(cells);
    find_planes(cells, grid);
    const std::vector<std::size_t> target = join_layers(cells, means.noise, length);
    std::vector<std::uint32_t> number(cells.size());
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < cells.size(); ++v)
        if (target[v] == v) number[v] = count++;
    means.xyz.resize(3, count);
    means.normals.resize(3, count);
    means.counts.resize(count);
    means.of_point.resize(xyz.cols());
    Eigen::Matrix3Xd hints = Eigen::Matrix3Xd::Zero(3, count); // towards the outer side
    std::vector<std::vector<std::uint32_t>> neighbours(count);
    for (std::size_t v = 0; v < cells.size(); ++v) {
        const std::uint32_t i = number[target[v]];
        for (const std::uint32_t p : grid.points(v)) means.of_point[p] = i;
        if (sides.normals.cols() > 0)
            for (const std::uint32_t p : grid.points(v)) hints.col(i) += sides.normals.col(p);
        for (const std::uint32_t other : cells[v].neighbours)
            if (number[target[other]] != i) neighbours[i].push_back(number[target[other]]);
        if (target[v] != v) continue;
        means.xyz.col(i) = cells[v].moments.mean;
        means.normals.col(i) = cells[v].normal;
        means.counts[i] = cells[v].moments.count;
    }
    if (sides.has_view) hints = -(means.xyz.colwise() - sides.view);
    means.outward = sides.has_view || sides.normals.cols() > 0;
    geometry::orient_consistently(means.normals, means.xyz, neighbours, hints);
    return means;
}

} // namespace fettle::merge
