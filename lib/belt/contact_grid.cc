#include "belt/contact_grid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle {

using Eigen::Index;
using Eigen::Vector2d;

Eigen::Matrix3Xd facing(const Surfels& surfels, std::vector<Index>& which, const Eigen::Isometry3d& T_part_tool,
                        const ContactCells& cells, double deepest)
{
    const Eigen::Matrix3d to_tool = T_part_tool.linear().transpose();
    const Eigen::Vector3d middle = T_part_tool.translation(), up = to_tool.row(2);
    const Vector2d half = kBeside * cells.half();
    const auto looked_at = static_cast<Index>(which.size());
    Eigen::Matrix3Xd points(3, looked_at);
    std::vector<char> is_facing(which.size(), 0);
    constexpr Index kTogether = 2048; // a share of work worth a thread
    tbb::parallel_for(tbb::blocked_range<Index>(0, looked_at, kTogether), [&](const tbb::blocked_range<Index>& range) {
        for (Index k = range.begin(); k < range.end(); ++k) {
            const Index i = which[static_cast<std::size_t>(k)];
            Eigen::Vector3d at = to_tool * (surfels.position.col(i) - middle);
            const double displacement = surfels.displacement[i], aside = std::abs(displacement);
            if (std::abs(at.x()) > half.x() + aside || std::abs(at.y()) > half.y() + aside) continue;
            if (!(surfels.normal.col(i).dot(up) > 0)) continue;
            at += displacement * (to_tool * surfels.normal.col(i));
            if (!(std::abs(at.x()) <= half.x() && std::abs(at.y()) <= half.y() && at.z() >= -deepest)) continue;
            points.col(k) = at;
            is_facing[static_cast<std::size_t>(k)] = 1;
        }
    });
    std::size_t count = 0;
    for (std::size_t k = 0; k < which.size(); ++k) {
        if (!is_facing[k]) continue;
        points.col(static_cast<Index>(count)) = points.col(static_cast<Index>(k));
        which[count++] = which[k];
    }
    which.resize(count);
    return points.leftCols(static_cast<Index>(count));
}

SquareMeans::SquareMeans(const ContactCells& cells, const Eigen::MatrixXd& field, double side)
    : cells_(cells), cells_each_(1 / cells.cell.array()), middle_(cells.half().array() * cells_each_),
      half_(side / 2 * cells_each_), sums_(Eigen::MatrixXd::Zero(cells.rows + 1, cells.columns + 1))
{
    for (Index j = 0; j < cells.columns; ++j) {
        double column = 0;
        for (Index i = 0; i < cells.rows; ++i) {
            column += field(i, j);
            sums_(i + 1, j + 1) = sums_(i + 1, j) + column;
        }
    }
}

/// The sum of the cells, and parts of cells, before a place.
double SquareMeans::until(const Along& x, const Along& y) const
{
    const double* column = sums_.data() + y.cell * sums_.rows() + x.cell;
    const double* next = column + sums_.rows();
    return (1 - y.part) * ((1 - x.part) * column[0] + x.part * column[1]) +
           y.part * ((1 - x.part) * next[0] + x.part * next[1]);
}

double SquareMeans::about(const Vector2d& place) const
{
    const auto along = [](double at, Index cells) {
        const double inside = std::clamp(at, 0.0, static_cast<double>(cells));
        const Index cell = std::min(static_cast<Index>(inside), cells - 1);
        return Along{cell, inside - static_cast<double>(cell)};
    };
    const Eigen::Array2d middle = place.array() * cells_each_ + middle_;
    const Along left = along(middle.x() - half_.x(), cells_.rows), right = along(middle.x() + half_.x(), cells_.rows);
    const Along low = along(middle.y() - half_.y(), cells_.columns);
    const Along high = along(middle.y() + half_.y(), cells_.columns);
    const double sum = until(right, high) - until(left, high) - until(right, low) + until(left, low);
    return std::max(sum, 0.0) / (4 * half_.prod()); // rounding may leave less than nothing
}

Eigen::AlignedBox2d box_over(const Eigen::Matrix3Xd& points)
{
    constexpr double kNone = std::numeric_limits<double>::infinity();
    Vector2d least(kNone, kNone), most(-kNone, -kNone);
    for (Index i = 0; i < points.cols(); ++i) {
        const Vector2d at(points(0, i), points(1, i));
        least = at.cwiseMin(least);
        most = at.cwiseMax(most);
    }
    return {least, most};
}

double spacing_of(const Eigen::Matrix3Xd& points)
{
    const Vector2d size = box_over(points).sizes();
    const auto n = static_cast<double>(points.cols());
    // A lattice of m x m points is m - 1 spacings wide; few points, or points on a line, have no better one.
    return std::max(std::sqrt(size.prod()) / std::max(std::sqrt(n) - 1, 1.0), size.maxCoeff() / n);
}

} // namespace fettle
