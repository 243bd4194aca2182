#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace fettle::mesh {

struct BoxTree;

/// Ray casting and closest point queries against a mesh. The results are those of an exhaustive search in double; among
/// equally near triangles the one with the lowest index is returned. Thread-safe.
class MeshIndex {
  public:
    /// @param mesh  must outlive the index, which takes another 32 bytes per triangle
    explicit MeshIndex(const Mesh& mesh);
    MeshIndex(MeshIndex&&) noexcept;
    ~MeshIndex();

    struct Hit {
        double distance = 0; ///< along the ray, mm
        Eigen::Index triangle = 0;
        Eigen::Vector3d point;
    };
    /// First hit of a ray, which never passes between two triangles at their common edge or vertex (see WatertightRay).
    std::optional<Hit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& unit_direction) const;
    /// Highest point of the mesh over (x, y).
    std::optional<Hit> highest(double x, double y) const;

    struct Closest {
        Eigen::Vector3d point;
        Eigen::Index triangle = 0;
        Eigen::Vector3d barycentric; ///< of `point` in the triangle; exactly 0 off a vertex or edge that holds it
        std::uint32_t leaf = 0;      ///< leaf of the triangle: a good start for a query nearby
    };
    /// Closest point within `radius`, mm, if there is one.
    /// @param leaf  where the search starts; it affects only the time
    std::optional<Closest> closest(const Eigen::Vector3d& point, double radius, std::uint32_t leaf = 0) const;

    /// Triangles near a point, ascending: all that have a point within `distance`, mm, and of the others only such
    /// whose bounding boxes do.
    std::vector<std::uint32_t> nearby(const Eigen::Vector3d& point, double distance) const;

    const Mesh& mesh() const;
    /// The tree, for searches of other kinds.
    const BoxTree& tree() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle::mesh
