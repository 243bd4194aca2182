#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::geometry {

/// Points of a plane sorted into square cells of a few points each, for searches a few cells wide. It stays beside
/// PointIndex because it is sorted in linear time: on a scan of a million points all of fettle-sample takes 0.1 s, the
/// k-d tree alone would take 0.2 s more. Also, what is found comes in the order of the cells.
struct PlanarGrid {
    Eigen::Vector2d min;                           ///< corner of the first cell
    double side = 0;                               ///< of a cell
    Eigen::Array2i count = Eigen::Array2i::Zero(); ///< cells in x and y
    std::vector<int> order;                        ///< columns of the points by cell, ascending in each cell
    std::vector<int> begin;                        ///< points of cell c = x + y count.x(): order[begin[c]] up to
                                                   ///< order[begin[c + 1]]

    /// The cell of a point; for a point beside the grid, the nearest cell.
    Eigen::Array2i cell_of(const Eigen::Array2d& p) const
    {
        const Eigen::Array2d cell = ((p - min.array()) / side).floor();
        return cell.max(0).min(count.cast<double>() - 1).cast<int>();
    }
};

/// @param points  2xN, at least one and fewer than 2³¹, all of them finite
PlanarGrid planar_grid(const Eigen::Ref<const Eigen::Matrix2Xd, 0, Eigen::OuterStride<>>& points,
                       double points_per_cell);

/// Calls visit(k) for the point in column grid.order[k], for the points of all cells that meet a box, k ascending. A
/// box beside the grid gets the nearest cells.
template <typename Visit>
void visit_cells(const PlanarGrid& grid, const Eigen::Array2d& lower, const Eigen::Array2d& upper, const Visit& visit)
{
    const Eigen::Array2i first = grid.cell_of(lower), last = grid.cell_of(upper);
    for (Eigen::Index y = first.y(); y <= last.y(); ++y) {
        const Eigen::Index row = y * grid.count.x(), end = grid.begin[row + last.x() + 1];
        for (Eigen::Index k = grid.begin[row + first.x()]; k < end; ++k) visit(k);
    }
}

} // namespace fettle::geometry
