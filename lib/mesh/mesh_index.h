#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>

namespace fettle {

struct BoxTree;

/// Rays and closest points against a mesh: exact, whatever the tree. Of equally good triangles the one with the lowest
/// index wins. Thread-safe.
class MeshIndex {
  public:
    /// The mesh must outlive the index. 48 bytes a triangle.
    explicit MeshIndex(const Mesh& mesh);
    MeshIndex(MeshIndex&&) noexcept;
    ~MeshIndex();

    struct Hit {
        double distance = 0; ///< along the ray, mm
        Eigen::Index triangle = 0;
        Eigen::Vector3d point;
    };
    /// The first hit; edges and vertices are watertight.
    std::optional<Hit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& unit_direction) const;
    /// The highest point of the mesh over (x, y).
    std::optional<Hit> highest(double x, double y) const;

    struct Closest {
        Eigen::Vector3d point;
        Eigen::Index triangle = 0;
        Eigen::Vector3d barycentric; ///< of `point` in the triangle; exactly 0 off a vertex or edge that holds it
        std::uint32_t leaf = 0;      ///< of the index: where to begin with a point nearby
    };
    /// The closest point within `radius`, if there is one.
    /// @param leaf  where to begin; it changes nothing but the time
    std::optional<Closest> closest(const Eigen::Vector3d& point, double radius, std::uint32_t leaf = 0) const;

    const Mesh& mesh() const;
    /// For searches for something else than points.
    const BoxTree& tree() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle
