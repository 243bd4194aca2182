#pragma once

#include "mesh/mesh.h"
#include "mesh/mesh_index.h"
#include "robot/clearance.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <vector>

namespace fettle {

/// Is every side of a triangle shared with just one other, the other way round? Then the mesh has an inside.
bool is_closed(const Mesh& mesh);

/// A mesh that bodies are held against: every triangle counts, those that cannot be nearest are passed over by a tree
/// of boxes. Thread-safe.
class Workpiece {
  public:
    /// The mesh must outlive it.
    explicit Workpiece(const Mesh& mesh);

    struct Nearest {
        Clearance clearance;        ///< a is the body, b the triangle
        Eigen::Index triangle = -1; ///< -1: none within `beyond`, the distance is a bound
        bool inside = false;        ///< the body lies wholly inside: the distance is that out of the surface, negative
    };
    /// The least signed distance of the mesh's points from the body: apart, how far; overlapping, how deep the deepest
    /// of them lies inside it, whatever the triangles' size, to 1e-3 mm (of spheres and capsules exactly). Of a closed
    /// mesh a body that touches no triangle may lie inside.
    /// @param body  in the mesh's frame
    /// @param beyond  clearances beyond it need not be told apart
    Nearest nearest(const PlacedSolid& body, double beyond = std::numeric_limits<double>::infinity()) const;

    bool closed() const { return closed_; }
    const Mesh& mesh() const { return *mesh_; }

  private:
    struct Node {
        Eigen::AlignedBox3d box;
        std::uint32_t first = 0, count = 0; ///< triangles of a leaf; count 0: the children are `first` and `first` + 1
    };
    void build(std::uint32_t node, std::uint32_t first, std::uint32_t count, const Eigen::Matrix3Xd& centres);
    Triangle corners(std::uint32_t place) const;
    void look_at(const PlacedSolid& body, std::uint32_t place, Nearest& best) const;
    bool holds(const Eigen::Vector3d& point) const;

    const Mesh* mesh_;
    bool closed_;
    MeshIndex rays_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace fettle
