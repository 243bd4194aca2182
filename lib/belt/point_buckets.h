#pragma once

#include "geometry/planar_grid.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::belt {

inline constexpr Eigen::Index kMaxGridNeighbours = 8;
inline constexpr double kPointsPerBucket = 3;

/// The points nearest to a query, nearest first.
struct NearestPoints {
    Eigen::Index count = 0;
    std::array<double, kMaxGridNeighbours> squared_distance; ///< mm²
    std::array<Eigen::Index, kMaxGridNeighbours> index;

    void insert(double squared, Eigen::Index point)
    {
        Eigen::Index k = count < kMaxGridNeighbours ? count++ : kMaxGridNeighbours - 1;
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
class PointBuckets {
  public:
    PointBuckets(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& removed)
        : grid_(geometry::planar_grid(points.topRows<2>(), kPointsPerBucket)), points_(points(Eigen::all, grid_.order))
    {
        if (removed.size() > 0) removed_ = removed(grid_.order);
    }

    /// The points in the order of the buckets, row by row.
    const Eigen::Matrix3Xd& points() const { return points_; }
    /// Depth that they lost, in the same order; empty: unknown.
    const Eigen::VectorXd& removed() const { return removed_; }

    /// The nearest points within `max_distance`, mm.
    NearestPoints nearest(const Eigen::Vector2d& query, double max_distance) const
    {
        NearestPoints found;
        const double side = grid_.side;
        const Eigen::Array2d uv = (query - grid_.min) / side;
        const auto u = static_cast<Eigen::Index>(std::floor(uv.x())), v = static_cast<Eigen::Index>(std::floor(uv.y()));
        const Eigen::Array2d offset = (uv - Eigen::Array2d(double(u), double(v))) * side;
        const double border = std::min(offset.minCoeff(), side - offset.maxCoeff()); // to the sides of the own bucket
        double max_squared = max_distance * max_distance;
        search(u - 1, u + 1, v - 1, v + 1, query, max_squared, found);
        for (Eigen::Index ring = 2; border + (ring - 1) * side < std::sqrt(max_squared); ++ring) {
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
    void search(Eigen::Index first_u, Eigen::Index last_u, Eigen::Index first_v, Eigen::Index last_v,
                const Eigen::Vector2d& query, double& max_squared, NearestPoints& found) const
    {
        first_u = std::max<Eigen::Index>(first_u, 0);
        last_u = std::min<Eigen::Index>(last_u, grid_.count.x() - 1);
        if (first_u > last_u) return;
        for (Eigen::Index v = std::max<Eigen::Index>(first_v, 0);
             v <= std::min<Eigen::Index>(last_v, grid_.count.y() - 1); ++v) {
            const Eigen::Index row = v * grid_.count.x(), end = grid_.begin[row + last_u + 1];
            for (Eigen::Index i = grid_.begin[row + first_u]; i < end; ++i) {
                const double x = points_(0, i) - query.x(), y = points_(1, i) - query.y(), squared = x * x + y * y;
                if (!(squared < max_squared)) continue;
                found.insert(squared, i);
                if (found.count == kMaxGridNeighbours) max_squared = found.squared_distance.back();
            }
        }
    }

    geometry::PlanarGrid grid_;
    Eigen::Matrix3Xd points_;
    Eigen::VectorXd removed_;
};

} // namespace fettle::belt
