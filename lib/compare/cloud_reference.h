#pragma once

#include "cloud/cloud.h"

#include <Eigen/Core>

#include <memory>
#include <optional>

namespace fettle {

/// A point cloud as a surface: about each foot a quadratic height over the plane of the nearest points, fitted by
/// robust least squares (Tukey's biweight). Thread-safe.
class CloudReference {
  public:
    explicit CloudReference(const Cloud& cloud);
    CloudReference(CloudReference&&) noexcept;
    ~CloudReference();

    struct Foot {
        double error;           ///< of the point from the surface, + outward, mm
        Eigen::Vector3d normal; ///< of the surface, unit, outward
        Eigen::Vector3d point;  ///< of the surface
        double sigma;           ///< standard deviation of the fitted surface at the foot, mm
    };
    /// The point of the surface closest to `point`; nothing where the cloud does not surround it.
    std::optional<Foot> closest(const Eigen::Vector3d& point) const;
    /// Where the line through `point` meets the surface. @param direction  unit, outward
    std::optional<Foot> along(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

} // namespace fettle
