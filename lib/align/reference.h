#pragma once

#include "align/oriented_points.h"

#include <memory>

namespace fettle {

/// What a scan is aligned to: a mesh, or a cloud whose points are discs as wide as their spacing. Thread-safe.
class AlignReference {
  public:
    /// @throws InputError if there is nothing to align to: fewer than three points, a mesh without area
    explicit AlignReference(const Cloud& cloud);
    explicit AlignReference(const Mesh& mesh);
    ~AlignReference();

    struct Foot {
        Eigen::Vector3d point;  ///< the nearest one of the mesh, or of the discs
        Eigen::Vector3d normal; ///< unit; zero where the reference has no direction
    };
    Foot closest(const Eigen::Vector3d& point) const;

    /// Points all over it.
    const OrientedPoints& points() const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

} // namespace fettle
