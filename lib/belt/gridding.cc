#include "belt/gridding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Lanes4 = Eigen::Array4d;

constexpr Index kNearest = 8;

/// The points nearest to a place, nearest first.
struct Nearest {
    Index count = 0;
    std::array<double, kNearest> square; ///< of the distance
    std::array<Index, kNearest> which;

    void add(double farther, Index point)
    {
        Index k = count < kNearest ? count++ : kNearest - 1;
        for (; k > 0 && square[std::size_t(k - 1)] > farther; --k) {
            square[std::size_t(k)] = square[std::size_t(k - 1)];
            which[std::size_t(k)] = which[std::size_t(k - 1)];
        }
        square[std::size_t(k)] = farther;
        which[std::size_t(k)] = point;
    }
};

/// Points in square buckets, about three in each, so that those nearest to a place are as a rule in its bucket and the
/// eight around it.
class Buckets {
  public:
    explicit Buckets(const Matrix3Xd& points)
    {
        const Eigen::AlignedBox2d box = box_over(points);
        least_ = box.min();
        const Vector2d size = box.sizes();
        const auto n = static_cast<double>(points.cols());
        constexpr double kEach = 3;
        constexpr double kLeast = 1e-9; // mm: all points at one place
        side_ = std::max({std::sqrt(kEach * size.prod() / n), kEach * size.maxCoeff() / n, kLeast});
        counts_ = (size / side_).array().cast<Index>() + 1;
        sort(points);
    }

    /// In the order of the buckets, row by row.
    const Matrix3Xd& points() const { return points_; }

    /// Those nearer than `reach`, or the nearest of them.
    Nearest nearest(const Vector2d& place, double reach) const
    {
        Nearest found;
        const Eigen::Array2d at = (place - least_) / side_;
        const auto u = static_cast<Index>(std::floor(at.x())), v = static_cast<Index>(std::floor(at.y()));
        const Eigen::Array2d into = (at - Eigen::Array2d(double(u), double(v))) * side_;
        const double border = std::min(into.minCoeff(), side_ - into.maxCoeff()); // of the place's own bucket
        double most = reach * reach;
        look_into(u - 1, u + 1, v - 1, v + 1, place, most, found);
        for (Index ring = 2; border + static_cast<double>(ring - 1) * side_ < std::sqrt(most); ++ring) {
            look_into(u - ring, u + ring, v - ring, v - ring, place, most, found);
            look_into(u - ring, u - ring, v - ring + 1, v + ring - 1, place, most, found);
            look_into(u + ring, u + ring, v - ring + 1, v + ring - 1, place, most, found);
            look_into(u - ring, u + ring, v + ring, v + ring, place, most, found);
        }
        return found;
    }

  private:
    void sort(const Matrix3Xd& points)
    {
        std::vector<std::int32_t> bucket(static_cast<std::size_t>(points.cols()));
        begin_.assign(static_cast<std::size_t>(counts_.prod()) + 2, 0);
        const double each = 1 / side_;
        for (Index i = 0; i < points.cols(); ++i) {
            const auto u = std::min(static_cast<Index>((points(0, i) - least_.x()) * each), counts_.x() - 1);
            const auto v = std::min(static_cast<Index>((points(1, i) - least_.y()) * each), counts_.y() - 1);
            const Index b = v * counts_.x() + u;
            bucket[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(b);
            ++begin_[static_cast<std::size_t>(b) + 2];
        }
        for (std::size_t b = 2; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
        points_.resize(3, points.cols());
        for (Index i = 0; i < points.cols(); ++i)
            points_.col(begin_[static_cast<std::size_t>(bucket[static_cast<std::size_t>(i)]) + 1]++) = points.col(i);
        begin_.pop_back();
    }

    /// @param most  square of the distance that the nearest of the points not yet found may have
    void look_into(Index first_u, Index last_u, Index first_v, Index last_v, const Vector2d& place, double& most,
                   Nearest& found) const
    {
        first_u = std::max<Index>(first_u, 0);
        last_u = std::min(last_u, counts_.x() - 1);
        if (first_u > last_u) return;
        for (Index v = std::max<Index>(first_v, 0); v <= std::min(last_v, counts_.y() - 1); ++v) {
            const Index end = begin_[static_cast<std::size_t>(v * counts_.x() + last_u + 1)];
            for (Index i = begin_[static_cast<std::size_t>(v * counts_.x() + first_u)]; i < end; ++i) {
                const double x = points_(0, i) - place.x(), y = points_(1, i) - place.y(), square = x * x + y * y;
                if (!(square < most)) continue;
                found.add(square, i);
                if (found.count == kNearest) most = found.square.back();
            }
        }
    }

    Matrix3Xd points_;
    Vector2d least_;
    double side_;
    Eigen::Array<Index, 2, 1> counts_;
    std::vector<Index> begin_; ///< of the points of each bucket
};

double shepard(const Nearest& near, const Matrix3Xd& points)
{
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(near.count); ++k) {
        const double height = points(2, near.which[k]);
        if (near.square[k] == 0) return height;
        sum += height / near.square[k];
        weights += 1 / near.square[k];
    }
    return sum / weights;
}

/// Ordinary kriging at four places at once, one in each lane.
class KrigingOfFour {
  public:
    static constexpr Index kLanes = 4;

    KrigingOfFour()
    {
        for (std::size_t k = 0; k < kNearest; ++k) x_[k] = y_[k] = z_[k] = Lanes4::Zero();
    }

    /// Where fewer points are near, the nearest stands for the rest of them.
    void set(Index lane, const Vector2d& place, const Nearest& near, const Matrix3Xd& points)
    {
        for (std::size_t k = 0; k < kNearest; ++k) {
            const Index i = near.which[k < static_cast<std::size_t>(near.count) ? k : 0];
            x_[k][lane] = points(0, i) - place.x();
            y_[k][lane] = points(1, i) - place.y();
            z_[k][lane] = points(2, i);
        }
    }

    /// With the covariance c(d) = 2 (greatest distance) - d in place of the variogram: the same weights, and a definite
    /// matrix C, C_ij = c(|p_i - p_j|). Of b_i = c(|p_i - place|) and the heights z the estimate is
    /// b C⁻¹z + (1 - b C⁻¹1) (1 C⁻¹z) / (1 C⁻¹1); by C = L D Lᵀ, b C⁻¹z = (L⁻¹b) D⁻¹ (L⁻¹z).
    Lanes4 heights()
    {
        Lanes4 one[kNearest], b[kNearest];
        covariances(one, b);
        Lanes4 bz = Lanes4::Zero(), b1 = bz, z1 = bz, ones = bz;
        for (std::size_t j = 0; j < kNearest; ++j) {
            // Column j of L times D is left in C_; what it takes from the columns after it:
            const Lanes4 each = 1 / C_[j][j];
            bz += b[j] * z_[j] * each;
            b1 += b[j] * one[j] * each;
            z1 += z_[j] * one[j] * each;
            ones += one[j] * one[j] * each;
            for (std::size_t i = j + 1; i < kNearest; ++i) {
                const Lanes4 share = C_[i][j] * each;
                for (std::size_t k = j + 1; k <= i; ++k) C_[i][k] -= share * C_[k][j];
                b[i] -= share * b[j];
                z_[i] -= share * z_[j];
                one[i] -= share * one[j];
            }
        }
        return bz + (1 - b1) * z1 / ones;
    }

  private:
    /// @param one  1; 0 for a point at the place of an earlier one, which has no weight: the first stands for both
    void covariances(Lanes4* one, Lanes4* b)
    {
        constexpr double kLeast = 1e-9; // mm: one point, at the place
        Lanes4 farthest = Lanes4::Constant(kLeast);
        for (std::size_t i = 0; i < kNearest; ++i) {
            Lanes4 least = Lanes4::Ones();
            for (std::size_t j = 0; j < i; ++j) {
                C_[i][j] = ((x_[i] - x_[j]).square() + (y_[i] - y_[j]).square()).sqrt();
                farthest = farthest.max(C_[i][j]);
                least = least.min(C_[i][j]);
            }
            one[i] = (least > 0).select(Lanes4::Ones(), Lanes4::Zero());
            b[i] = (x_[i].square() + y_[i].square()).sqrt();
            farthest = farthest.max(b[i]);
        }
        const Lanes4 at_0 = 2 * farthest;
        for (std::size_t i = 0; i < kNearest; ++i) {
            for (std::size_t j = 0; j < i; ++j) C_[i][j] = one[i] * one[j] * (at_0 - C_[i][j]);
            C_[i][i] = one[i] * at_0 + (1 - one[i]);
            b[i] = one[i] * (at_0 - b[i]);
            z_[i] *= one[i];
        }
    }

    Lanes4 x_[kNearest], y_[kNearest], z_[kNearest]; ///< from the place; height
    Lanes4 C_[kNearest][kNearest];                   ///< below and on the diagonal
};

} // namespace

Eigen::MatrixXd heights_on(const ContactCells& cells, const Matrix3Xd& points, Gridding gridding)
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Eigen::MatrixXd heights = Eigen::MatrixXd::Constant(cells.rows, cells.columns, kNone);
    if (points.cols() == 0) return heights;
    const Buckets buckets(points);
    const double spacing = spacing_of(points);
    constexpr double kNear = 2, kReach = 3; // spacings
    tbb::parallel_for(Index{0}, cells.columns, [&](Index column) {
        KrigingOfFour kriging;
        Index rows[KrigingOfFour::kLanes], lanes = 0;
        const auto finish = [&] {
            const Lanes4 found = kriging.heights();
            for (Index lane = 0; lane < lanes; ++lane) heights(rows[lane], column) = found[lane];
            lanes = 0;
        };
        for (Index row = 0; row < cells.rows; ++row) {
            const Vector2d place = cells.middle(row, column);
            const Nearest near = buckets.nearest(place, kReach * spacing);
            if (near.count == 0 || !(std::sqrt(near.square[0]) <= kNear * spacing)) continue;
            if (gridding == Gridding::shepard) {
                heights(row, column) = shepard(near, buckets.points());
                continue;
            }
            kriging.set(lanes, place, near, buckets.points());
            rows[lanes++] = row;
            if (lanes == KrigingOfFour::kLanes) finish();
        }
        if (lanes > 0) finish();
    });
    return heights;
}

} // namespace fettle
