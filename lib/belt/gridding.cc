#include "belt/gridding.h"

#include "geometry/planar_grid.h"

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace fettle::belt {

namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Lanes4 = Eigen::Array4d;

constexpr Index kMaxGridNeighbours = 8;
constexpr double kPointsPerBucket = 3;

/// The points nearest to a query, nearest first.
struct Nearest {
    Index count = 0;
    std::array<double, kMaxGridNeighbours> squared_distance; ///< mm²
    std::array<Index, kMaxGridNeighbours> index;

    void insert(double squared, Index point)
    {
        Index k = count < kMaxGridNeighbours ? count++ : kMaxGridNeighbours - 1;
        for (; k > 0 && squared_distance[k - 1] > squared; --k) {
            squared_distance[k] = squared_distance[k - 1];
            index[k] = index[k - 1];
        }
        squared_distance[k] = squared;
        index[k] = point;
    }
};

/// The points in square buckets of about three, so that the nearest ones are usually in the query's bucket or the eight
/// around it. A geometry::PointIndex would break ties otherwise, and surfels on a lattice have many.
class Buckets {
  public:
    Buckets(const Matrix3Xd& points, const Eigen::VectorXd& removed)
        : grid_(geometry::planar_grid(points.topRows<2>(), kPointsPerBucket)), points_(points(Eigen::all, grid_.order))
    {
        if (removed.size() > 0) removed_ = removed(grid_.order);
    }

    /// The points in the order of the buckets, row by row.
    const Matrix3Xd& points() const { return points_; }
    /// Depth that they lost, in the same order; empty: unknown.
    const Eigen::VectorXd& removed() const { return removed_; }

    /// The nearest points within `max_distance`, mm.
    Nearest nearest(const Vector2d& query, double max_distance) const
    {
        Nearest found;
        const double side = grid_.side;
        const Eigen::Array2d uv = (query - grid_.min) / side;
        const auto u = static_cast<Index>(std::floor(uv.x())), v = static_cast<Index>(std::floor(uv.y()));
        const Eigen::Array2d offset = (uv - Eigen::Array2d(double(u), double(v))) * side;
        const double border = std::min(offset.minCoeff(), side - offset.maxCoeff()); // to the sides of the own bucket
        double max_squared = max_distance * max_distance;
        search(u - 1, u + 1, v - 1, v + 1, query, max_squared, found);
        for (Index ring = 2; border + (ring - 1) * side < std::sqrt(max_squared); ++ring) {
            search(u - ring, u + ring, v - ring, v - ring, query, max_squared, found);
            search(u - ring, u - ring, v - ring + 1, v + ring - 1, query, max_squared, found);
            search(u + ring, u + ring, v - ring + 1, v + ring - 1, query, max_squared, found);
            search(u - ring, u + ring, v + ring, v + ring, query, max_squared, found);
        }
        return found;
    }

  private:
    /// Searches a range of buckets.
    /// @param max_squared  square of the search radius, mm²; shrinks to the last neighbour's once there are enough
    void search(Index first_u, Index last_u, Index first_v, Index last_v, const Vector2d& query, double& max_squared,
                Nearest& found) const
    {
        first_u = std::max<Index>(first_u, 0);
        last_u = std::min<Index>(last_u, grid_.count.x() - 1);
        if (first_u > last_u) return;
        for (Index v = std::max<Index>(first_v, 0); v <= std::min<Index>(last_v, grid_.count.y() - 1); ++v) {
            const Index row = v * grid_.count.x(), end = grid_.begin[row + last_u + 1];
            for (Index i = grid_.begin[row + first_u]; i < end; ++i) {
                const double x = points_(0, i) - query.x(), y = points_(1, i) - query.y(), squared = x * x + y * y;
                if (!(squared < max_squared)) continue;
                found.insert(squared, i);
                if (found.count == kMaxGridNeighbours) max_squared = found.squared_distance.back();
            }
        }
    }

    geometry::PlanarGrid grid_;
    Matrix3Xd points_;
    Eigen::VectorXd removed_;
};

/// Is the query in the convex hull of its neighbours, so that its height is interpolated and not extrapolated? It is
/// not if all lie on one side of a line through it and one of them.
bool is_surrounded(const Vector2d& query, const Nearest& near, const Matrix3Xd& points)
{
    std::array<Vector2d, kMaxGridNeighbours> offsets;
    for (Index k = 0; k < near.count; ++k) offsets[k] = points.col(near.index[k]).head<2>() - query;
    for (Index i = 0; i < near.count; ++i) {
        bool has_right = false; // or straight across
        for (Index j = 0; j < near.count; ++j) {
            const double cross = offsets[i].x() * offsets[j].y() - offsets[i].y() * offsets[j].x();
            has_right = has_right || cross < 0 || (cross == 0 && offsets[i].dot(offsets[j]) < 0);
        }
        if (!has_right) return false;
    }
    return true;
}

double shepard(const Nearest& near, const Matrix3Xd& points)
{
    double sum = 0, weights = 0;
    for (Index k = 0; k < near.count; ++k) {
        const double height = points(2, near.index[k]);
        if (near.squared_distance[k] == 0) return height;
        sum += height / near.squared_distance[k];
        weights += 1 / near.squared_distance[k];
    }
    return sum / weights;
}

/// Ordinary kriging at four points at once, one in each SIMD lane.
class KrigingOfFour {
  public:
    static constexpr Index kLanes = 4;

    KrigingOfFour()
    {
        for (Index k = 0; k < kMaxGridNeighbours; ++k) x_[k] = y_[k] = z_[k] = Lanes4::Zero();
    }

    /// Sets the query of a lane. If it has fewer than kMaxGridNeighbours neighbours, the nearest one is repeated.
    void set(Index lane, const Vector2d& query, const Nearest& near, const Matrix3Xd& points)
    {
        for (Index k = 0; k < kMaxGridNeighbours; ++k) {
            const Index i = near.index[k < near.count ? k : 0];
            x_[k][lane] = points(0, i) - query.x();
            y_[k][lane] = points(1, i) - query.y();
            z_[k][lane] = points(2, i);
        }
    }
    /// Adds what the points lost to the heights that were set.
    void add(Index lane, const Nearest& near, const Eigen::VectorXd& removed)
    {
        for (Index k = 0; k < kMaxGridNeighbours; ++k) z_[k][lane] += removed[near.index[k < near.count ? k : 0]];
    }

    /// Uses the covariance c(d) = 2 (max. distance) - d instead of the variogram: the weights are the same, and the
    /// matrix C, C_ij = c(|p_i - p_j|), is definite. With b_i = c(|p_i - query|) and the heights z the estimate is b
    /// C⁻¹z + (1 - b C⁻¹1) (1 C⁻¹z) / (1 C⁻¹1); by C = L D Lᵀ, b C⁻¹z = (L⁻¹b) D⁻¹ (L⁻¹z).
    Lanes4 heights()
    {
        Lanes4 one[kMaxGridNeighbours], b[kMaxGridNeighbours];
        covariances(one, b);
        Lanes4 bz = Lanes4::Zero(), b1 = bz, z1 = bz, ones = bz;
        for (Index j = 0; j < kMaxGridNeighbours; ++j) {
            // Column j of C_ is that of L D. It is eliminated from the columns after it.
            const Lanes4 inverse_pivot = 1 / C_[j][j];
            bz += b[j] * z_[j] * inverse_pivot;
            b1 += b[j] * one[j] * inverse_pivot;
            z1 += z_[j] * one[j] * inverse_pivot;
            ones += one[j] * one[j] * inverse_pivot;
            for (Index i = j + 1; i < kMaxGridNeighbours; ++i) {
                const Lanes4 factor = C_[i][j] * inverse_pivot;
                for (Index k = j + 1; k <= i; ++k) C_[i][k] -= factor * C_[k][j];
                b[i] -= factor * b[j];
                z_[i] -= factor * z_[j];
                one[i] -= factor * one[j];
            }
        }
        return bz + (1 - b1) * z1 / ones;
    }

  private:
    /// Computes C_, and decouples points that coincide with an earlier one.
    /// @param one  1; 0 for a decoupled point
    /// @param b    covariances with the query
    void covariances(Lanes4* one, Lanes4* b)
    {
        constexpr double kMinDistance = 1e-9; // mm, for a single point at the query
        Lanes4 max_distance = Lanes4::Constant(kMinDistance);
        for (Index i = 0; i < kMaxGridNeighbours; ++i) {
            Lanes4 min_distance = Lanes4::Ones();
            for (Index j = 0; j < i; ++j) {
                C_[i][j] = ((x_[i] - x_[j]).square() + (y_[i] - y_[j]).square()).sqrt();
                max_distance = max_distance.max(C_[i][j]);
                min_distance = min_distance.min(C_[i][j]);
            }
            one[i] = (min_distance > 0).select(Lanes4::Ones(), Lanes4::Zero());
            b[i] = (x_[i].square() + y_[i].square()).sqrt();
            max_distance = max_distance.max(b[i]);
        }
        const Lanes4 variance = 2 * max_distance;
        for (Index i = 0; i < kMaxGridNeighbours; ++i) {
            for (Index j = 0; j < i; ++j) C_[i][j] = one[i] * one[j] * (variance - C_[i][j]);
            C_[i][i] = one[i] * variance + (1 - one[i]);
            b[i] = one[i] * (variance - b[i]);
            z_[i] *= one[i];
        }
    }

    Lanes4 x_[kMaxGridNeighbours], y_[kMaxGridNeighbours], z_[kMaxGridNeighbours]; ///< from the query; height
    Lanes4 C_[kMaxGridNeighbours][kMaxGridNeighbours];                             ///< lower triangle
};

/// The ground surface at a query between points that a wheel has touched and others, beside the kink between them.
struct BesideKink {
    double ground;   ///< height of the plane through the touched points, mm
    double min, max; ///< of the depths that the points lost, mm
    double height(double before) const { return before - std::clamp(before - ground, min, max); }
};

/// @return  empty away from a kink, and where the touched points do not determine a plane
std::optional<BesideKink> beside_kink(const Vector2d& query, const Nearest& near, const Buckets& buckets)
{
    constexpr double kMinTouchedShare = 0.1; // of the deepest: squares that a contact only grazes lost less
    const Eigen::VectorXd& removed = buckets.removed();
    if (removed.size() == 0) return std::nullopt;
    BesideKink found{0, removed[near.index[0]], removed[near.index[0]]};
    for (Index k = 1; k < near.count; ++k) {
        found.min = std::min(found.min, removed[near.index[k]]);
        found.max = std::max(found.max, removed[near.index[k]]);
    }
    if (!(found.min < kMinTouchedShare * found.max) || near.squared_distance[0] == 0) return std::nullopt;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (Index k = 0; k < near.count; ++k) {
        const Index i = near.index[k];
        if (removed[i] < kMinTouchedShare * found.max) continue;
        const Eigen::Vector3d point = buckets.points().col(i), row(1, point.x() - query.x(), point.y() - query.y());
        const double weight = near.squared_distance[0] / near.squared_distance[k];
        normal += weight * row * row.transpose();
        right += weight * point.z() * row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    constexpr double kMinPivotShare = 1e-6; // points in a row have none but rounding
    if (!(solver.vectorD().minCoeff() > kMinPivotShare * solver.vectorD().maxCoeff())) return std::nullopt;
    found.ground = solver.solve(right)[0];
    return found;
}

/// The area over the workpiece.
class Outline {
  public:
    Outline(const Buckets& buckets, double spacing) : buckets_(buckets), spacing_(spacing) {}

    Nearest nearest(const Vector2d& query) const
    {
        constexpr double kSearchRadiusSpacings = 3;
        return buckets_.nearest(query, kSearchRadiusSpacings * spacing_);
    }

    /// A surfel stands for a square of one spacing. The part ends where those of its last surfels do: discs of this
    /// radius reach half a spacing, on average, beyond a straight row of them. A gap between surfels is bridged, up to
    /// a width.
    bool contains(const Vector2d& query, const Nearest& near) const
    {
        constexpr double kSurfelRadiusSpacings = 0.583, kMaxBridgeSpacings = 2;
        if (near.count == 0) return false;
        const double nearest = std::sqrt(near.squared_distance[0]) / spacing_;
        return nearest <= kSurfelRadiusSpacings ||
               (nearest <= kMaxBridgeSpacings && is_surrounded(query, near, buckets_.points()));
    }

    /// Share of a cell, from samples no two of which share a row or a column of its 16 x 16 pieces.
    double coverage(const Vector2d& center, const Vector2d& cell_size) const
    {
        constexpr Index kSamples = 16, kStride = 7; // 7 has no factor in common with 16
        Index inside = 0;
        for (Index k = 0; k < kSamples; ++k) {
            const Eigen::Array2d place(static_cast<double>(k), static_cast<double>(k * kStride % kSamples));
            const Vector2d sample = center.array() + cell_size.array() * ((place + 0.5) / kSamples - 0.5);
            inside += contains(sample, nearest(sample)) ? 1 : 0;
        }
        return static_cast<double>(inside) / kSamples;
    }

  private:
    const Buckets& buckets_;
    double spacing_;
};

/// Coverage of the cells along the workpiece's border; of the others, whether their centre is inside.
Eigen::MatrixXd cell_coverage(const ContactGrid& grid, const Outline& outline, const Eigen::MatrixXd& center_inside)
{
    Eigen::MatrixXd coverage = center_inside;
    const auto is_at_border = [&](Index row, Index column) {
        const Index top = std::max<Index>(row - 1, 0), left = std::max<Index>(column - 1, 0);
        const auto around = center_inside.block(top, left, std::min(row + 2, grid.rows) - top,
                                                std::min(column + 2, grid.columns) - left);
        return around.minCoeff() != around.maxCoeff();
    };
    tbb::parallel_for(Index{0}, grid.columns, [&](Index column) {
        for (Index row = 0; row < grid.rows; ++row)
            if (is_at_border(row, column))
                coverage(row, column) = outline.coverage(grid.cell_center(row, column), grid.cell_size);
    });
    return coverage;
}

} // namespace

GriddedHeights interpolate_heights(const ContactGrid& grid, const Matrix3Xd& points, Gridding gridding,
                                   const Eigen::VectorXd& removed)
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    GriddedHeights result{Eigen::MatrixXd::Constant(grid.rows, grid.columns, kNan),
                          Eigen::MatrixXd::Zero(grid.rows, grid.columns)};
    if (points.cols() == 0) return result;
    const Buckets buckets(points, removed);
    const Outline outline(buckets, mean_spacing(points));
    // Beside the workpiece the height is that of its border, for cells that lie partly over it.
    Eigen::MatrixXd center_inside = result.coverage;
    tbb::parallel_for(Index{0}, grid.columns, [&](Index column) {
        KrigingOfFour kriging;
        Index rows[KrigingOfFour::kLanes], lanes = 0;
        std::optional<BesideKink> kinks[KrigingOfFour::kLanes];
        const auto solve_lanes = [&] {
            const Lanes4 results = kriging.heights();
            for (Index lane = 0; lane < lanes; ++lane)
                result.height(rows[lane], column) = kinks[lane] ? kinks[lane]->height(results[lane]) : results[lane];
            lanes = 0;
        };
        for (Index row = 0; row < grid.rows; ++row) {
            const Vector2d center = grid.cell_center(row, column);
            const Nearest near = outline.nearest(center);
            if (near.count == 0) continue;
            center_inside(row, column) = outline.contains(center, near) ? 1 : 0;
            if (gridding == Gridding::shepard) {
                result.height(row, column) = shepard(near, buckets.points());
                continue;
            }
            kriging.set(lanes, center, near, buckets.points());
            kinks[lanes] = beside_kink(center, near, buckets);
            if (kinks[lanes]) kriging.add(lanes, near, buckets.removed());
            rows[lanes++] = row;
            if (lanes == KrigingOfFour::kLanes) solve_lanes();
        }
        if (lanes > 0) solve_lanes();
    });
    result.coverage = cell_coverage(grid, outline, center_inside);
    result.height = (result.coverage.array() > 0).select(result.height, kNan);
    return result;
}

} // namespace fettle::belt
