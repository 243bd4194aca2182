#include "belt/contact_grid.h"

#include "geometry/bounding_box.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::belt {

using Eigen::Index;
using Eigen::Vector2d;

Eigen::Matrix3Xd select_facing_surfels(const Surfels& surfels, std::vector<Index>& indices,
                                       const Eigen::Isometry3d& T_part_tool, const ContactGrid& grid, double max_depth)
{
    const Eigen::Matrix3d R_tool_part = T_part_tool.linear().transpose();
    const Eigen::Vector3d origin = T_part_tool.translation(), up = R_tool_part.row(2);
    const Vector2d limit = kGridMargin * grid.half_size();
    const Index candidates = std::ssize(indices);
    Eigen::Matrix3Xd points(3, candidates);
    std::vector<char> is_selected(indices.size(), 0);
    constexpr Index kGrainSize = 2048; // surfels for one task
    tbb::parallel_for(
        tbb::blocked_range<Index>(0, candidates, kGrainSize), [&](const tbb::blocked_range<Index>& range) {
            for (Index k = range.begin(); k < range.end(); ++k) {
                const Index i = indices[k];
                Eigen::Vector3d p = R_tool_part * (surfels.position.col(i) - origin);
                const double displacement = surfels.displacement[i], max_shift = std::abs(displacement);
                if (std::abs(p.x()) > limit.x() + max_shift || std::abs(p.y()) > limit.y() + max_shift) continue;
                if (!(surfels.normal.col(i).dot(up) > 0)) continue;
                p += displacement * (R_tool_part * surfels.normal.col(i));
                if (!(std::abs(p.x()) <= limit.x() && std::abs(p.y()) <= limit.y() && p.z() >= -max_depth)) continue;
                points.col(k) = p;
                is_selected[k] = 1;
            }
        });
    Index count = 0;
    for (Index k = 0; k < candidates; ++k) {
        if (!is_selected[k]) continue;
        points.col(count) = points.col(k);
        indices[count++] = indices[k];
    }
    indices.resize(count);
    return points.leftCols(count);
}

BoxAverage::BoxAverage(const ContactGrid& grid, const Eigen::MatrixXd& field, double side)
    : grid_(grid), cells_per_mm_(1 / grid.cell_size.array()), half_grid_(grid.half_size().array() * cells_per_mm_),
      half_side_(side / 2 * cells_per_mm_), sums_(Eigen::MatrixXd::Zero(grid.rows + 1, grid.columns + 1))
{
    for (Index j = 0; j < grid.columns; ++j) {
        double column_sum = 0;
        for (Index i = 0; i < grid.rows; ++i) {
            column_sum += field(i, j);
            sums_(i + 1, j + 1) = sums_(i + 1, j) + column_sum;
        }
    }
}

/// Integral of the field, in cells, from the corner of the grid to a point: bilinear in the table.
double BoxAverage::integral_to(const CellCoordinate& x, const CellCoordinate& y) const
{
    const double* column = sums_.data() + y.cell * sums_.rows() + x.cell;
    const double* next = column + sums_.rows();
    return (1 - y.fraction) * ((1 - x.fraction) * column[0] + x.fraction * column[1]) +
           y.fraction * ((1 - x.fraction) * next[0] + x.fraction * next[1]);
}

double BoxAverage::mean_around(const Vector2d& center) const
{
    const auto coordinate = [](double x, Index count) {
        const double inside = std::clamp(x, 0.0, static_cast<double>(count));
        const Index cell = std::min(static_cast<Index>(inside), count - 1);
        return CellCoordinate{cell, inside - static_cast<double>(cell)};
    };
    const Eigen::Array2d middle = center.array() * cells_per_mm_ + half_grid_;
    const Eigen::Array2d first = middle - half_side_, last = middle + half_side_;
    const CellCoordinate left = coordinate(first.x(), grid_.rows), right = coordinate(last.x(), grid_.rows);
    const CellCoordinate low = coordinate(first.y(), grid_.columns), high = coordinate(last.y(), grid_.columns);
    const double sum =
        integral_to(right, high) - integral_to(left, high) - integral_to(right, low) + integral_to(left, low);
    return std::max(sum, 0.0) / (4 * half_side_.prod()); // rounding may make the sum negative
}

double mean_spacing(const Eigen::Matrix3Xd& points)
{
    const Vector2d size = geometry::bounding_box(points.topRows<2>()).sizes();
    const auto n = static_cast<double>(points.cols());
    // A lattice of m x m points is m - 1 spacings wide. For few or collinear points this is not defined, and the length
    // over the number of points is used.
    return std::max(std::sqrt(size.prod()) / std::max(std::sqrt(n) - 1, 1.0), size.maxCoeff() / n);
}

} // namespace fettle::belt
