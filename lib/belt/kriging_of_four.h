#pragma once

#include "belt/point_buckets.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Ordinary kriging (Cressie 1993, 3.2) at four points at once, one in each SIMD lane.
class KrigingOfFour {
  public:
    using Lanes4 = Eigen::Array4d;
    static constexpr Eigen::Index kLanes = 4;

    KrigingOfFour()
    {
        for (Eigen::Index k = 0; k < kMaxGridNeighbours; ++k) x_[k] = y_[k] = z_[k] = Lanes4::Zero();
    }

    /// Sets the query of a lane. If it has fewer than kMaxGridNeighbours neighbours, the nearest one is repeated.
    void set(Eigen::Index lane, const Eigen::Vector2d& query, const NearestPoints& near, const Eigen::Matrix3Xd& points)
    {
        for (Eigen::Index k = 0; k < kMaxGridNeighbours; ++k) {
            const Eigen::Index i = near.index[k < near.count ? k : 0];
            x_[k][lane] = points(0, i) - query.x();
            y_[k][lane] = points(1, i) - query.y();
            z_[k][lane] = points(2, i);
        }
    }
    /// Adds what the points lost to the heights that were set.
    void add(Eigen::Index lane, const NearestPoints& near, const Eigen::VectorXd& removed)
    {
        for (Eigen::Index k = 0; k < kMaxGridNeighbours; ++k)
            z_[k][lane] += removed[near.index[k < near.count ? k : 0]];
    }

    /// Uses the covariance c(d) = 2 (max. distance) - d instead of the variogram: the weights are the same, and the
    /// matrix C, C_ij = c(|p_i - p_j|), is definite. With b_i = c(|p_i - query|) and the heights z the estimate is b
    /// C⁻¹z + (1 - b C⁻¹1) (1 C⁻¹z) / (1 C⁻¹1); by C = L D Lᵀ, b C⁻¹z = (L⁻¹b) D⁻¹ (L⁻¹z).
    Lanes4 heights()
    {
        Lanes4 one[kMaxGridNeighbours], b[kMaxGridNeighbours];
        covariances(one, b);
        Lanes4 bz = Lanes4::Zero(), b1 = bz, z1 = bz, ones = bz;
        for (Eigen::Index j = 0; j < kMaxGridNeighbours; ++j) {
            // Column j of C_ is that of L D. It is eliminated from the columns after it.
            const Lanes4 inverse_pivot = 1 / C_[j][j];
            bz += b[j] * z_[j] * inverse_pivot;
            b1 += b[j] * one[j] * inverse_pivot;
            z1 += z_[j] * one[j] * inverse_pivot;
            ones += one[j] * one[j] * inverse_pivot;
            for (Eigen::Index i = j + 1; i < kMaxGridNeighbours; ++i) {
                const Lanes4 factor = C_[i][j] * inverse_pivot;
                for (Eigen::Index k = j + 1; k <= i; ++k) C_[i][k] -= factor * C_[k][j];
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
        for (Eigen::Index i = 0; i < kMaxGridNeighbours; ++i) {
            Lanes4 min_distance = Lanes4::Ones();
            for (Eigen::Index j = 0; j < i; ++j) {
                C_[i][j] = ((x_[i] - x_[j]).square() + (y_[i] - y_[j]).square()).sqrt();
                max_distance = max_distance.max(C_[i][j]);
                min_distance = min_distance.min(C_[i][j]);
            }
            one[i] = (min_distance > 0).select(Lanes4::Ones(), Lanes4::Zero());
            b[i] = (x_[i].square() + y_[i].square()).sqrt();
            max_distance = max_distance.max(b[i]);
        }
        const Lanes4 variance = 2 * max_distance;
        for (Eigen::Index i = 0; i < kMaxGridNeighbours; ++i) {
            for (Eigen::Index j = 0; j < i; ++j) C_[i][j] = one[i] * one[j] * (variance - C_[i][j]);
            C_[i][i] = one[i] * variance + (1 - one[i]);
            b[i] = one[i] * (variance - b[i]);
            z_[i] *= one[i];
        }
    }

    Lanes4 x_[kMaxGridNeighbours], y_[kMaxGridNeighbours], z_[kMaxGridNeighbours]; ///< from the query; height
    Lanes4 C_[kMaxGridNeighbours][kMaxGridNeighbours];                             ///< lower triangle
};

} // namespace fettle::belt
