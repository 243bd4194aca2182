#pragma once

#include "mesh/mesh.h"
#include "mesh/mesh_index.h"
#include "robot/clearance.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
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
        bool inside = false;        ///< the body, or the centre of a ball, lies inside
        std::uint32_t leaf = 0;     ///< of the tree: where to begin with a body that is moved a little
    };
    /// The least signed distance of the mesh's points from the body: apart, how far; overlapping, how deep the deepest
    /// of them lies inside it, whatever the triangles' size, to kClearanceTolerance (of boxes and hulls to 1e-3 mm). A
    /// body that lies wholly inside a closed mesh, and a ball whose centre does, must go through the nearest point of
    /// the surface to come out: the way to beyond its plane, negative.
    /// @param body  in the mesh's frame
    /// @param beyond  clearances beyond it need not be told apart
    /// @param leaf  where to begin: Nearest::leaf of a body nearby. It changes nothing but the time, and the last
    ///              digits
    Nearest nearest(const PlacedSolid& body, double beyond = std::numeric_limits<double>::infinity(),
                    std::uint32_t leaf = 0) const;

    /// Of those triangles alone that are asked for, as far as they lie outside the body or pierce it: nothing is
    /// inside.
    Nearest nearest_of(const PlacedSolid& body, double beyond, const std::function<bool(Eigen::Index)>& wanted) const;

    /// Does the point lie inside a closed mesh?
    bool holds(const Eigen::Vector3d& point) const;

    bool closed() const { return closed_; }
    const Mesh& mesh() const { return index_.mesh(); }

  private:
    void find(const PlacedSolid& body, const std::function<bool(Eigen::Index)>* wanted, Nearest& best) const;
    bool is_inside(const Nearest& nearest, const Eigen::Vector3d& point) const;

    bool closed_;
    MeshIndex index_;
};

} // namespace fettle
