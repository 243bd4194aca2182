#pragma once

#include "cloud/cloud.h"

#include <Eigen/Core>

#include <memory>
#include <optional>

namespace fettle::compare {

/// Surface through a point cloud: around each foot, a quadratic height over the plane of the nearest points, fitted by
/// robust least squares (Tukey's biweight). pcl::MovingLeastSquares weights by distance alone, so that outliers
/// pull the surface; it fills gaps, and gives no standard deviation. Thread-safe.
class CloudReference {
  public:
    explicit CloudReference(const cloud::Cloud& cloud);
    CloudReference(CloudReference&&) noexcept;
    ~CloudReference();

    struct Foot {
        double error;           ///< signed distance of the point from the surface, + outward, mm
        Eigen::Vector3d normal; ///< of the surface at the foot, unit, outward
        Eigen::Vector3d point;  ///< the foot itself
        double sigma;           ///< standard deviation of the fitted height at the foot, mm
    };
    /// The point of the surface closest to `point`; nothing where the cloud does not surround it.
    std::optional<Foot> closest(const Eigen::Vector3d& point) const;
    /// Intersection of the surface with the line through `point`; nothing as above. @param direction  unit, outward
    std::optional<Foot> intersect_line(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

} // namespace fettle::compare
