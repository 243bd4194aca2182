#pragma once

#include "align/oriented_points.h"

#include <memory>
#include <optional>

namespace fettle::align {

/// The surface that a scan is aligned to: a mesh, or a cloud whose points are discs as wide as their spacing.
/// Thread-safe.
class AlignReference {
  public:
    /// @throws InputError if there is nothing to align to: fewer than three points, a mesh without area
    explicit AlignReference(const cloud::Cloud& cloud);
    explicit AlignReference(const mesh::Mesh& mesh);
    explicit AlignReference(OrientedPoints points);
    AlignReference(AlignReference&& other) noexcept;
    ~AlignReference();

    /// This surface with fewer points, evenly spaced in their order: searches take less time. None for a mesh, and
    /// where there are no more than `count` points.
    std::optional<AlignReference> thinned(Eigen::Index count) const;

    struct Foot {
        Eigen::Vector3d point;  ///< the closest point of the mesh, or of the discs
        Eigen::Vector3d normal; ///< unit; zero where the reference has no direction
    };
    Foot closest(const Eigen::Vector3d& point) const;

    /// Samples of the whole reference.
    const OrientedPoints& points() const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

} // namespace fettle::align
