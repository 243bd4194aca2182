#include "belt/gridding.h"

#include "belt/kriging_of_four.h"
#include "belt/point_buckets.h"

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

/// Is the query in the convex hull of its neighbours, so that its height is interpolated and not extrapolated? It is
/// not if all lie on one side of a line through it and one of them.
bool is_surrounded(const Vector2d& query, const NearestPoints& near, const Matrix3Xd& points)
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

double shepard(const NearestPoints& near, const Matrix3Xd& points)
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

/// The ground surface at a query between points that a wheel has touched and others, beside the kink between them.
struct BesideKink {
    double ground;   ///< height of the plane through the touched points, mm
    double min, max; ///< of the depths that the points lost, mm
    double height(double before) const { return before - std::clamp(before - ground, min, max); }
};

/// @return  empty away from a kink, and where the touched points do not determine a plane
std::optional<BesideKink> beside_kink(const Vector2d& query, const NearestPoints& near, const PointBuckets& buckets)
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
    Outline(const PointBuckets& buckets, double spacing) : buckets_(buckets), spacing_(spacing) {}

    NearestPoints nearest(const Vector2d& query) const
    {
        constexpr double kSearchRadiusSpacings = 3;
        return buckets_.nearest(query, kSearchRadiusSpacings * spacing_);
    }

    /// A surfel stands for a square of one spacing. The part ends where those of its last surfels do: discs of this
    /// radius reach half a spacing, on average, beyond a straight row of them. A gap between surfels is bridged, up to
    /// a width.
    bool contains(const Vector2d& query, const NearestPoints& near) const
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
    const PointBuckets& buckets_;
    double spacing_;
};

/// Coverage of the cells along the workpiece's border; of the others, whether their centre is inside.
Eigen::MatrixXd cell_coverage(const ContactGrid& grid, const Outline& outline, const Eigen::MatrixXd& center_inside)
{
    Eigen::MatrixXd coverage = center_inside;
    if (center_inside.minCoeff() == center_inside.maxCoeff()) return coverage;
    const auto is_at_border = [&](Index row, Index column) {
        const double own = center_inside(row, column);
        for (Index j = std::max<Index>(column - 1, 0); j < std::min(column + 2, grid.columns); ++j)
            for (Index i = std::max<Index>(row - 1, 0); i < std::min(row + 2, grid.rows); ++i)
                if (center_inside(i, j) != own) return true;
        return false;
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
    const PointBuckets buckets(points, removed);
    const Outline outline(buckets, mean_spacing(points));
    // Beside the workpiece the height is that of its border, for cells that lie partly over it.
    Eigen::MatrixXd center_inside = result.coverage;
    tbb::parallel_for(Index{0}, grid.columns, [&](Index column) {
        KrigingOfFour kriging;
        Index rows[KrigingOfFour::kLanes], lanes = 0;
        std::optional<BesideKink> kinks[KrigingOfFour::kLanes];
        const auto solve_lanes = [&] {
            const KrigingOfFour::Lanes4 results = kriging.heights();
            for (Index lane = 0; lane < lanes; ++lane)
                result.height(rows[lane], column) = kinks[lane] ? kinks[lane]->height(results[lane]) : results[lane];
            lanes = 0;
        };
        for (Index row = 0; row < grid.rows; ++row) {
            const Vector2d center = grid.cell_center(row, column);
            const NearestPoints near = outline.nearest(center);
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
