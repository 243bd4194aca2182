#pragma once

#include "mesh/mesh.h"
#include "mesh/mesh_index.h"
#include "robot/clearance.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <limits>

namespace fettle::robot {

/// A mesh for distance queries of bodies. Every triangle counts; a tree of boxes spares those that cannot be nearest.
/// Thread-safe. FCL decides overlaps with a mesh, too, but does not give their depth.
class Workpiece {
  public:
    /// The mesh must outlive it.
    explicit Workpiece(const mesh::Mesh& mesh);

    struct Nearest {
        Clearance clearance;        ///< a is the body, b the triangle
        Eigen::Index triangle = -1; ///< -1: none within `max_distance`, and the distance is that bound
        bool inside = false;        ///< the body, or the centre of a sphere, lies inside a closed mesh
        std::uint32_t leaf = 0;     ///< of the tree, a good start for a query with the body moved a little
    };
    /// The minimum signed distance of the mesh's points from the body, mm: if they overlap, the negative depth of the
    /// deepest point inside the body, whatever the size of the triangles. Accurate to kClearanceAccuracy. A body that
    /// lies completely inside a closed mesh, and a sphere whose centre does, must leave through the nearest point of
    /// the surface: the result is the negative distance that it moves until it is beyond the plane there.
    /// @param body  in the mesh's frame
    /// @param max_distance  larger distances are reported as this one
    /// @param start_leaf  where the search starts, Nearest::leaf of a body nearby. It affects the time, and the result
    ///                    only within its accuracy
    Nearest nearest(const PlacedSolid& body, double max_distance = std::numeric_limits<double>::infinity(),
                    std::uint32_t start_leaf = 0) const;

    /// nearest() without the test whether the body lies wholly inside, for bodies that are known not to.
    Nearest nearest_of_surface(const PlacedSolid& body, double max_distance, std::uint32_t start_leaf) const;

    /// A lower bound of what nearest_of_surface() finds, no larger than `max_distance`: the bounds in float alone,
    /// which differ from the distance about as much as the body's surface curves over a triangle.
    struct LowerBound {
        double distance = 0;
        std::uint32_t leaf = 0; ///< as Nearest::leaf
    };
    LowerBound lower_bound(const PlacedSolid& body, double max_distance, std::uint32_t start_leaf) const;

    /// The minimum signed distance of a subset of the triangles. As a subset bounds no volume, `inside` stays false.
    Nearest nearest_of(const PlacedSolid& body, double max_distance,
                       const std::function<bool(Eigen::Index)>& is_selected) const;

    /// Does the point lie inside a closed mesh?
    bool contains(const Eigen::Vector3d& point) const;

    bool closed() const { return closed_; }
    const mesh::Mesh& mesh() const { return index_.mesh(); }
    /// The tree, for searches of other kinds.
    const mesh::BoxTree& tree() const { return index_.tree(); }

  private:
    void search(const PlacedSolid& body, const std::function<bool(Eigen::Index)>* is_selected, Nearest& best,
                bool bounds_only = false) const;
    bool is_inside(const Nearest& nearest, const Eigen::Vector3d& point) const;

    bool closed_;
    double outwards_; ///< 1: the triangles' normals point out of the mesh; -1: into it, as of a file that is inside out
    mesh::MeshIndex index_;
};

} // namespace fettle::robot
