#pragma once

#include "cloud/point_source.h"
#include "fit/cell_moments.h"
#include "job/boundary.h"
#include "job/job.h"
#include "surface/surface.h"

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fettle {

// Sums over blocks depend on their order: block k always goes to lane k modulo kBlockLanes, each lane adds its blocks
// in order, and lanes are added in order, whatever the number of threads.
inline constexpr std::size_t kBlockLanes = 8;

/// Calls work(lane, first, block) for all blocks of a source; lanes run in parallel.
template <typename Work>
void for_blocks(const PointSource& source, const Work& work)
{
    tbb::parallel_for(std::size_t{0}, kBlockLanes, [&](std::size_t lane) {
        PointBlock block;
        for (std::size_t first = lane * source.block; first < source.points; first += kBlockLanes * source.block) {
            source.read(first, std::min(source.block, source.points - first), block);
            work(lane, first, block);
        }
    });
}

/// What became of the points of a scan.
struct PointCounts {
    std::size_t undefined = 0;  ///< a coordinate is NaN
    std::size_t other_role = 0; ///< estimated points, corners of B
    std::size_t anomaly = 0;    ///< inside B
    std::size_t outside = 0;    ///< outside S
    std::size_t used = 0;

    PointCounts& operator+=(const PointCounts& other);
    std::size_t ignored() const { return undefined + other_role + anomaly + outside; }
};

/// Which points of a source say something about the desired surface, and the grid that they are put on. With roles:
/// those of samples, wherever they lie. Without, the source is a scan that shows the anomaly, too: the points outside B
/// and inside S.
struct DensePoints {
    PointSource source;
    bool use_boundary = false; ///< take role 0, too
    Boundaries region;         ///< W; both empty with roles
    Bspline grid;              ///< aligned with W, around B and the points; its heights are 0

    /// Of a cell or a part of one: what its points are, as far as they are all alike; else which edges cross it.
    enum Cell : std::uint8_t { take, drop_anomaly, drop_outside, edge_of_anomaly, edge_of_sampling, edge_of_both };
    std::vector<Cell> cells;              ///< column-major
    static constexpr int kParts = 8;      ///< along a side of a cell that edges cross
    std::vector<Cell> parts;              ///< kParts x kParts of each such cell, column-major
    std::vector<std::int32_t> first_part; ///< of each cell, in `parts`; -1: it has none
    double largest = 0;                   ///< |coordinate|, mm
};

/// Reads the points once to see where they lie.
/// @throws InputError for fewer than 6 that may be used, or points on a line, or a role that is none
DensePoints dense_points(const PointSource& source, const Job& job, bool use_boundary, const std::string& name);

/// The points of a block that are used, by their cells; the others are counted.
void locate(const DensePoints& points, const PointBlock& block, std::vector<CellPoint>& into, PointCounts& counts);

/// The same points on another grid over the same rectangle.
void relocate(const std::vector<CellPoint>& points, const Bspline& from, const Bspline& to,
              std::vector<CellPoint>& into);

/// M, of a place in the grid, in cells from its corner.
Eigen::Vector2d place_in(const Bspline& grid, const Eigen::Vector2d& uv);

} // namespace fettle
