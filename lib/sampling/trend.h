#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace fettle {

/// A polynomial z(x, y) through touches, by least squares: for slopes at the touches, never for the desired surface.
/// Its terms follow the job's surface: plane; cubic across the rulings and a slope along them; full cubic.
class Trend {
  public:
    /// @param points  3xN, M, mm; fewer than the terms: the smallest coefficients
    Trend(const Job& job, const Eigen::Matrix3Xd& points);

    double height(const Eigen::Vector2d& xy) const;
    Eigen::Vector2d gradient(const Eigen::Vector2d& xy) const;

  private:
    Eigen::Vector2d scaled(const Eigen::Vector2d& xy) const;

    std::vector<std::pair<int, int>> powers_;
    Eigen::Matrix2d turn_; ///< from M to the frame of the terms
    Eigen::Vector2d centre_;
    double scale_ = 1; ///< mm
    Eigen::VectorXd coefficients_;
};

} // namespace fettle
