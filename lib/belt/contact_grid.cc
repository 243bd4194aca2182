#include "belt/contact_grid.h"

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr Index kNearest = 8;

/// A point and its squared distance.
using Near = std::pair<double, Index>;

/// Points in square buckets, about two in each.
class Buckets {
  public:
    explicit Buckets(const Eigen::Matrix3Xd& points) : points_(points)
    {
        least_ = points.topRows<2>().rowwise().minCoeff();
        const Vector2d size = points.topRows<2>().rowwise().maxCoeff() - least_;
        const auto n = static_cast<double>(points.cols());
        constexpr double kLeast = 1e-9; // mm: all points at one place
        side_ = std::max(std::sqrt(2 * size.prod() / n), std::max(2 * size.maxCoeff() / n, kLeast));
        counts_ = (size / side_).array().floor().cast<Index>() + 1;
        begin_.assign(static_cast<std::size_t>(counts_.prod()) + 1, 0);
        for (Index i = 0; i < points.cols(); ++i) ++begin_[bucket_of(i) + 1];
        for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
        order_.resize(static_cast<std::size_t>(points.cols()));
        std::vector<Index> next(begin_.begin(), begin_.end() - 1);
        for (Index i = 0; i < points.cols(); ++i) order_[static_cast<std::size_t>(next[bucket_of(i)]++)] = i;
    }

    /// Up to kNearest points within `reach`, nearest first.
    void nearest(const Vector2d& place, double reach, std::vector<Near>& result) const
    {
        result.clear();
        const Eigen::Array2d at = (place - least_) / side_;
        const Eigen::Array<Index, 2, 1> middle = at.floor().cast<Index>();
        const auto rings = static_cast<Index>(std::ceil(reach / side_));
        for (Index ring = 0; ring <= rings; ++ring) {
            // Whatever lies in this ring is at least that far.
            const double least = (static_cast<double>(ring) - 1) * side_;
            if (static_cast<Index>(result.size()) == kNearest && ring > 0 && least * least > result.back().first)
                return;
            for (Index v = middle.y() - ring; v <= middle.y() + ring; ++v) {
                const bool edge = std::abs(v - middle.y()) == ring;
                for (Index u = middle.x() - ring; u <= middle.x() + ring; u += edge || ring == 0 ? 1 : 2 * ring)
                    look_into(u, v, place, reach, result);
            }
        }
    }

  private:
    std::size_t bucket_of(Index i) const
    {
        const Eigen::Array2d at = (points_.col(i).head<2>() - least_) / side_;
        const Eigen::Array<Index, 2, 1> b = at.floor().cast<Index>().min(counts_ - 1);
        return static_cast<std::size_t>(b.y() * counts_.x() + b.x());
    }

    void look_into(Index u, Index v, const Vector2d& place, double reach, std::vector<Near>& result) const
    {
        if (u < 0 || v < 0 || u >= counts_.x() || v >= counts_.y()) return;
        const auto b = static_cast<std::size_t>(v * counts_.x() + u);
        for (Index k = begin_[b]; k < begin_[b + 1]; ++k) {
            const Index i = order_[static_cast<std::size_t>(k)];
            const Near near((points_.col(i).head<2>() - place).squaredNorm(), i);
            if (near.first > reach * reach) continue;
            if (static_cast<Index>(result.size()) == kNearest) {
                if (!(near < result.back())) continue;
                result.pop_back();
            }
            result.insert(std::upper_bound(result.begin(), result.end(), near), near);
        }
    }

    const Eigen::Matrix3Xd& points_;
    Vector2d least_;
    double side_;
    Eigen::Array<Index, 2, 1> counts_;
    std::vector<Index> begin_, order_;
};

double shepard(const std::vector<Near>& near, const Eigen::Matrix3Xd& points)
{
    double sum = 0, weights = 0;
    for (const auto& [square, i] : near) {
        if (square == 0) return points(2, i);
        sum += points(2, i) / square;
        weights += 1 / square;
    }
    return sum / weights;
}

/// With the covariance 2 (greatest distance) - d in place of the variogram: the same weights, by Cholesky.
double kriging(const std::vector<Near>& near, const Eigen::Matrix3Xd& points)
{
    using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kNearest, kNearest>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNearest, 1>;
    using Columns = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kNearest, 2>;
    Eigen::Matrix<double, 3, kNearest> apart; // two heights at one place have no weights: the first stands for both
    Column distance(kNearest);
    Index n = 0;
    for (const auto& [square, i] : near) {
        const auto same = (apart.leftCols(n).topRows<2>().colwise() - points.col(i).head<2>()).colwise().squaredNorm();
        if (n > 0 && same.minCoeff() == 0) continue;
        distance[n] = std::sqrt(square);
        apart.col(n++) = points.col(i);
    }
    System A(n, n);
    for (Index k = 0; k < n; ++k)
        A.col(k) = (apart.leftCols(n).topRows<2>().colwise() - apart.col(k).head<2>()).colwise().norm().transpose();
    const double shift = 2 * std::max(A.maxCoeff(), distance.head(n).maxCoeff());
    A = shift - A.array();
    const Column b = shift - distance.head(n).array();
    Columns right(n, 2);
    right << apart.leftCols(n).row(2).transpose(), Column::Ones(n);
    const Columns solved = A.llt().solve(right);
    return b.dot(solved.col(0)) + (1 - b.dot(solved.col(1))) * solved.col(0).sum() / solved.col(1).sum();
}

} // namespace

Eigen::Matrix3Xd facing(const Surfels& surfels, std::vector<Index>& which, const Eigen::Isometry3d& T_part_tool,
                        const ContactCells& cells, double deepest)
{
    const Eigen::Matrix3d to_tool = T_part_tool.linear().transpose();
    const Eigen::Vector3d middle = T_part_tool.translation(), up = to_tool.row(2);
    const Vector2d half = kBeside * cells.half();
    Eigen::Matrix3Xd points(3, static_cast<Index>(which.size()));
    std::size_t count = 0;
    for (const Index i : which) {
        Eigen::Vector3d at = to_tool * (surfels.position.col(i) - middle);
        const double displacement = surfels.displacement[i], aside = std::abs(displacement);
        if (std::abs(at.x()) > half.x() + aside || std::abs(at.y()) > half.y() + aside) continue;
        if (!(surfels.normal.col(i).dot(up) > 0)) continue;
        at += displacement * (to_tool * surfels.normal.col(i));
        if (!(std::abs(at.x()) <= half.x() && std::abs(at.y()) <= half.y() && at.z() >= -deepest)) continue;
        points.col(static_cast<Index>(count)) = at;
        which[count++] = i;
    }
    which.resize(count);
    return points.leftCols(static_cast<Index>(count));
}

SquareMeans::SquareMeans(const ContactCells& cells, const Eigen::MatrixXd& field, double side)
    : cells_(cells), side_(side), sums_(Eigen::MatrixXd::Zero(cells.rows + 1, cells.columns + 1))
{
    for (Index j = 0; j < cells.columns; ++j) {
        double column = 0;
        for (Index i = 0; i < cells.rows; ++i) {
            column += field(i, j);
            sums_(i + 1, j + 1) = sums_(i + 1, j) + column;
        }
    }
}

/// The sum of the cells, and parts of cells, before a place, in cells from the first corner.
double SquareMeans::until(double x, double y) const
{
    const double u = std::clamp(x, 0.0, static_cast<double>(cells_.rows));
    const double v = std::clamp(y, 0.0, static_cast<double>(cells_.columns));
    const Index i = std::min(static_cast<Index>(u), cells_.rows - 1);
    const Index j = std::min(static_cast<Index>(v), cells_.columns - 1);
    const double p = u - static_cast<double>(i), q = v - static_cast<double>(j);
    return (1 - q) * ((1 - p) * sums_(i, j) + p * sums_(i + 1, j)) +
           q * ((1 - p) * sums_(i, j + 1) + p * sums_(i + 1, j + 1));
}

double SquareMeans::about(const Vector2d& place) const
{
    const Eigen::Array2d half = side_ / 2 / cells_.cell.array();
    const Eigen::Array2d middle = (place + cells_.half()).array() / cells_.cell.array();
    const Eigen::Array2d low = middle - half, high = middle + half;
    const double sum =
        until(high.x(), high.y()) - until(low.x(), high.y()) - until(high.x(), low.y()) + until(low.x(), low.y());
    return std::max(sum, 0.0) / (4 * half.prod()); // rounding may leave less than nothing
}

double spacing_of(const Eigen::Matrix3Xd& points)
{
    const Vector2d size = points.topRows<2>().rowwise().maxCoeff() - points.topRows<2>().rowwise().minCoeff();
    const auto n = static_cast<double>(points.cols());
    // A lattice of m x m points is m - 1 spacings wide; few points, or points on a line, have no better one.
    return std::max(std::sqrt(size.prod()) / std::max(std::sqrt(n) - 1, 1.0), size.maxCoeff() / n);
}

Eigen::MatrixXd heights_on(const ContactCells& cells, const Eigen::Matrix3Xd& points, Gridding gridding)
{
    Eigen::MatrixXd heights =
        Eigen::MatrixXd::Constant(cells.rows, cells.columns, std::numeric_limits<double>::quiet_NaN());
    if (points.cols() == 0) return heights;
    const Buckets buckets(points);
    const double spacing = spacing_of(points);
    constexpr double kNear = 2; // spacings
    tbb::parallel_for(Index{0}, cells.columns, [&](Index column) {
        std::vector<Near> near;
        for (Index row = 0; row < cells.rows; ++row) {
            const Vector2d place = cells.middle(row, column);
            buckets.nearest(place, 3 * spacing, near);
            if (near.empty() || std::sqrt(near.front().first) > kNear * spacing) continue;
            heights(row, column) = gridding == Gridding::shepard ? shepard(near, points) : kriging(near, points);
        }
    });
    return heights;
}

} // namespace fettle
