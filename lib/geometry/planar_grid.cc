#include "geometry/planar_grid.h"

#include "geometry/bounding_box.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fettle::geometry {

PlanarGrid planar_grid(const Eigen::Ref<const Eigen::Matrix2Xd, 0, Eigen::OuterStride<>>& points,
                       double points_per_cell)
{
    constexpr double kMinSide = 1e-9;          // mm, if all points coincide
    constexpr Eigen::Index kGrainSize = 65536; // points for one task
    const Eigen::AlignedBox2d box = bounding_box(points);
    const Eigen::Vector2d size = box.sizes();
    const auto n = static_cast<double>(points.cols());
    PlanarGrid grid;
    grid.min = box.min();
    // Points on a line parallel to an axis have no area.
    grid.side =
        std::max({std::sqrt(points_per_cell * size.prod() / n), points_per_cell * size.maxCoeff() / n, kMinSide});
    grid.count = (size / grid.side).array().cast<int>() + 1;
    // Counting sort. Cells are counted two places on, so that filling them moves each cell's end to where it belongs.
    std::vector<int> cells(points.cols());
    grid.begin.assign(static_cast<std::size_t>(grid.count.x()) * grid.count.y() + 2, 0);
    using Range = tbb::blocked_range<Eigen::Index>;
    tbb::parallel_for(Range(0, points.cols(), kGrainSize), [&](const Range& range) {
        for (Eigen::Index i = range.begin(); i < range.end(); ++i) {
            // As cell_of(), but no point is beside the grid.
            const Eigen::Array2i cell = ((points.col(i) - grid.min) / grid.side).array().cast<int>();
            cells[i] = cell.y() * grid.count.x() + cell.x();
        }
    });
    for (const int cell : cells) ++grid.begin[cell + 2];
    std::partial_sum(grid.begin.begin(), grid.begin.end(), grid.begin.begin());
    grid.order.resize(points.cols());
    for (int i = 0; i < points.cols(); ++i) grid.order[grid.begin[cells[i] + 1]++] = i;
    grid.begin.pop_back();
    return grid;
}

} // namespace fettle::geometry
