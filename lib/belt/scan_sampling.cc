#include "belt/charts.h"
#include "belt/sampling.h"
#include "cloud/neighbours.h"
#include "core/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace fettle {
namespace {

// Neighbours of a surfel, over which charts grow: two rings of a hexagonal lattice, of which one side may be missing.
constexpr Eigen::Index kNeighbours = 12;
// A neighbour so many times as far as most nearest ones lies beyond a gap.
constexpr double kGap = 3;

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const
    {
        std::uint64_t hash = 0;
        for (const std::int64_t k : cell) hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
        return hash ^ hash >> 29;
    }
};

/// Columns of points of which none lies closer to an earlier one than the spacing.
std::vector<Eigen::Index> thinned(const Eigen::Matrix3Xd& points, double spacing)
{
    std::unordered_map<Cell, std::vector<Eigen::Index>, CellHash> taken;
    std::vector<Eigen::Index> kept;
    const auto near = [&](const Cell& cell, const Eigen::Vector3d& p) {
        for (std::int64_t n = 0; n < 27; ++n) {
            const auto found = taken.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
            if (found == taken.end()) continue;
            for (const Eigen::Index other : found->second)
                if ((points.col(other) - p).squaredNorm() < spacing * spacing) return true;
        }
        return false;
    };
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector3d p = points.col(i);
        if (!p.allFinite()) continue;
        Cell cell;
        for (int k = 0; k < 3; ++k) cell[static_cast<std::size_t>(k)] = std::llround(std::floor(p[k] / spacing));
        if (near(cell, p)) continue;
        taken[cell].push_back(i);
        kept.push_back(i);
    }
    return kept;
}

/// Neighbours of each point, and how far apart nearest points are.
struct Neighbourhood {
    Adjacency adjacency;
    double distance = 0; ///< the median, but the spacing at least, mm
};

Neighbourhood neighbourhood(const Eigen::Matrix3Xd& points, double spacing)
{
    const Neighbours neighbours(points);
    std::vector<std::vector<Eigen::Index>> near(static_cast<std::size_t>(points.cols()));
    tbb::parallel_for(std::size_t{0}, near.size(), [&](std::size_t i) {
        near[i] = neighbours.nearest(points.col(static_cast<Eigen::Index>(i)), kNeighbours + 1);
    });
    std::vector<double> distances = {0};
    for (std::size_t i = 0; i < near.size(); ++i)
        if (near[i].size() > 1)
            distances.push_back((points.col(near[i][1]) - points.col(static_cast<Eigen::Index>(i))).norm());
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    Neighbourhood found{{}, std::max(spacing, *middle)};
    Adjacency& adjacency = found.adjacency;
    for (std::size_t i = 0; i < near.size(); ++i) {
        adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
        const auto here = static_cast<Eigen::Index>(i);
        for (const Eigen::Index j : near[i])
            if (j != here && (points.col(j) - points.col(here)).norm() <= kGap * found.distance)
                adjacency.next.push_back(static_cast<int>(j));
    }
    adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
    return found;
}

} // namespace

SampledDesign sample_surfels(const Cloud& design, const std::string& source, const SurfelSampling& options)
{
    const std::vector<Eigen::Index> kept = thinned(design.xyz, options.spacing);
    if (kept.empty()) throw InputError(source, "no points");
    SampledDesign sampled;
    Surfels& surfels = sampled.surfels;
    surfels = surfels_of(select(design, kept), source);
    const Neighbourhood near = neighbourhood(surfels.position, options.spacing);
    const std::vector<Chart> charts = charts_of(near.adjacency, surfels.normal, Eigen::VectorXd::Ones(surfels.size()));
    surfels.radius.setConstant(near.distance);
    surfels.displacement.setZero();
    surfels.area.resize(0);
    for (std::size_t c = 0; c < charts.size(); ++c) {
        const std::vector<int>& elements = charts[c].elements;
        const Eigen::Matrix3Xd points = surfels.position(Eigen::all, elements);
        const Eigen::Matrix3d axes = rectangle_axes(points, charts[c].axes.col(2));
        surfels.uv(Eigen::all, elements) = axes.leftCols<2>().transpose() * points;
        for (const int i : elements) surfels.patch[i] = static_cast<int>(c);
    }
    sampled.patches = static_cast<int>(charts.size());
    sampled.least_spacing = near.distance;
    return sampled;
}

} // namespace fettle
