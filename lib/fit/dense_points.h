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

namespace fettle::fit {

// Rounding makes sums depend on their order, so it is fixed for any number of threads: block k always goes to lane k
// modulo kNumLanes, each lane adds its blocks in order, and lanes are added in order.
inline constexpr std::size_t kNumLanes = 8;

/// Calls work(lane, first, block) for all blocks of a source, `first` the index of the block's first point. Lanes run
/// in parallel, the blocks of a lane one after the other.
template <typename Work>
void parallel_for_blocks(const cloud::PointSource& source, const Work& work)
{
    tbb::parallel_for(std::size_t{0}, kNumLanes, [&](std::size_t lane) {
        cloud::PointBlock block;
        for (std::size_t first = lane * source.block_size; first < source.points;
             first += kNumLanes * source.block_size) {
            source.read(first, std::min(source.block_size, source.points - first), block);
            work(lane, first, block);
        }
    });
}

/// How many points of a scan are used, and how many are left out for which reason.
struct PointCounts {
    std::size_t undefined = 0;  ///< a coordinate is NaN
    std::size_t other_role = 0; ///< estimated points, corners of B
    std::size_t anomaly = 0;    ///< inside B
    std::size_t outside = 0;    ///< outside S
    std::size_t overhang = 0;   ///< its normal points down or sideways
    std::size_t used = 0;

    PointCounts& operator+=(const PointCounts& other);
    std::size_t ignored() const { return undefined + other_role + anomaly + outside + overhang; }
};

/// Which points of a source are fitted. Points whose normal points down or sideways never are: a height over x and y
/// has no undersides, overhangs and walls.
struct PointFilter {
    bool use_boundary = false; ///< points of role 0, too
    /// Only points outside B and inside S, as of a scan that covers the anomaly, too. Points without roles always are.
    bool by_place = false;
};

/// The points of a source that the desired surface is fitted to, and the spline's grid: those of sample roles, if there
/// are roles, and those in S outside B, if they are chosen by place.
struct DensePoints {
    cloud::PointSource source;
    PointFilter filter;
    job::Boundaries region; ///< W; both empty if points are not chosen by place
    surface::Bspline grid;  ///< aligned with W, around B and the points; its heights are 0

    /// The class of all points of a cell or subcell, or which edges cross it so that its points differ.
    enum Cell : std::uint8_t { take, drop_anomaly, drop_outside, edge_of_anomaly, edge_of_sampling, edge_of_both };
    std::vector<Cell> cells;                 ///< column-major
    static constexpr int kSubcells = 8;      ///< along a side of a cell that edges cross
    std::vector<Cell> subcells;              ///< kSubcells x kSubcells of each such cell, column-major
    std::vector<std::int32_t> first_subcell; ///< index into `subcells` for each cell; -1: the cell has none
    double max_abs_coordinate = 0;           ///< mm
};

/// Reads the points once to determine their extent.
/// @throws InputError for fewer than 6 points that can be used, points on a line, or an unknown role
DensePoints dense_points(const cloud::PointSource& source, const job::Job& job, const PointFilter& filter,
                         const std::string& name);

/// Replaces `used` by those points of a block that are used, each with its cell; adds all points to the counts.
void assign_cells(const DensePoints& points, const cloud::PointBlock& block, std::vector<CellPoint>& used,
                  PointCounts& counts);

/// Moves points to the cells of another grid over the same rectangle.
std::vector<CellPoint> regrid(const std::vector<CellPoint>& points, const surface::Bspline& from,
                              const surface::Bspline& to);

/// M, mm. @param uv  coordinates in the grid from its corner, in cells
Eigen::Vector2d machine_from_grid(const surface::Bspline& grid, const Eigen::Vector2d& uv);

} // namespace fettle::fit
