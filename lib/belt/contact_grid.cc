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

namespace {

/// Slope per cell that keeps between the neighbours' values.
double limited_slope(double before, double here, double after)
{
    const double left = here - before, right = after - here;
    if (!(left * right > 0)) return 0;
    const double size = std::min(std::abs(left + right) / 2, 2 * std::min(std::abs(left), std::abs(right)));
    return std::copysign(size, left);
}

} // namespace

BoxAverage::BoxAverage(const ContactGrid& grid, const Eigen::MatrixXd& field)
    : grid_(grid), cells_per_mm_(1 / grid.cell_size.array()), half_grid_(grid.half_size().array() * cells_per_mm_),
      sums_(Eigen::MatrixXd::Zero(grid.rows + 1, grid.columns + 1)), x_slopes_(sums_), y_slopes_(sums_)
{
    const Index rows = grid.rows, columns = grid.columns;
    const auto value = [&](Index i, Index j) { return i >= 0 && i < rows && j >= 0 && j < columns ? field(i, j) : 0; };
    for (Index j = 0; j < columns; ++j) {
        double column_sum = 0;
        for (Index i = 0; i < rows; ++i) {
            const double here = field(i, j);
            double x_slope = 0, y_slope = 0;
            if (here > 0) {
                column_sum += here;
                x_slope = limited_slope(value(i - 1, j), here, value(i + 1, j));
                y_slope = limited_slope(value(i, j - 1), here, value(i, j + 1));
                const double drop = (std::abs(x_slope) + std::abs(y_slope)) / 2; // at a corner of the cell
                if (drop > here) {
                    x_slope *= here / drop;
                    y_slope *= here / drop;
                }
            }
            sums_(i + 1, j + 1) = sums_(i + 1, j) + column_sum;
            x_slopes_(i, j + 1) = x_slopes_(i, j) + x_slope;
            y_slopes_(i + 1, j) = y_slopes_(i, j) + y_slope;
        }
    }
}

/// Integral of the field, in cells, from the corner of the grid to a point.
double BoxAverage::integral_to(const CellCoordinate& x, const CellCoordinate& y) const
{
    const Index at = y.cell * sums_.rows() + x.cell, above = at + sums_.rows();
    const double* sums = sums_.data();
    const auto between = [](double first, double last, double share) { return first + share * (last - first); };
    // Whole cells have their means; of the last ones, cut across a slope, the part below the cut is less or more.
    return between(between(sums[at], sums[at + 1], x.fraction), between(sums[above], sums[above + 1], x.fraction),
                   y.fraction) +
           x.parabola() * between(x_slopes_.data()[at], x_slopes_.data()[above], y.fraction) +
           y.parabola() * between(y_slopes_.data()[at], y_slopes_.data()[at + 1], x.fraction);
}

double BoxAverage::mean_around(const Vector2d& center, double side) const
{
    const auto coordinate = [](double x, Index count) {
        const double inside = std::clamp(x, 0.0, static_cast<double>(count));
        const Index cell = std::min(static_cast<Index>(inside), count - 1);
        return CellCoordinate{cell, inside - static_cast<double>(cell)};
    };
    const Eigen::Array2d middle = center.array() * cells_per_mm_ + half_grid_;
    const Eigen::Array2d half_side = side / 2 * cells_per_mm_, first = middle - half_side, last = middle + half_side;
    const CellCoordinate left = coordinate(first.x(), grid_.rows), right = coordinate(last.x(), grid_.rows);
    const CellCoordinate low = coordinate(first.y(), grid_.columns), high = coordinate(last.y(), grid_.columns);
    const double sum =
        integral_to(right, high) - integral_to(left, high) - integral_to(right, low) + integral_to(left, low);
    return std::max(sum, 0.0) / (4 * half_side.prod()); // rounding may make the sum negative
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
