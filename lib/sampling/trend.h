#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace fettle::sampling {

/// Least-squares polynomial z(x, y) through touches, used for slopes at the touches, not as the desired surface. The
/// terms depend on the job's surface type: a plane; cubic across the rulings and linear along them; a full cubic.
class Trend {
  public:
    /// @param points  3xN, M, mm; with fewer points than terms, the solution of minimum norm
    Trend(const job::Job& job, const Eigen::Matrix3Xd& points);

    double height(const Eigen::Vector2d& xy) const;
    Eigen::Vector2d gradient(const Eigen::Vector2d& xy) const;

  private:
    Eigen::Vector2d scaled(const Eigen::Vector2d& xy) const;

    std::vector<std::pair<int, int>> powers_;
    Eigen::Matrix2d rotation_; ///< from M to the frame of the terms
    Eigen::Vector2d centre_;
    double scale_ = 1; ///< mm
    Eigen::VectorXd coefficients_;
};

} // namespace fettle::sampling
