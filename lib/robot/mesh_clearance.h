#pragma once

#include "robot/clearance.h"
#include "robot/workpiece.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>

namespace fettle::robot {

/// Leaves of two meshes' trees whose triangles were the nearest: a good start for a query with a mesh moved a little.
struct LeafPair {
    std::uint32_t a = 0, b = 0;
};

/// The nearest triangles of two meshes.
struct NearestTriangles {
    Clearance clearance; ///< in the frame of b
    Eigen::Index triangle_a = -1,
                 triangle_b = -1; ///< -1: none within `max_distance`, and the distance is that bound
    bool inside = false;          ///< one of them lies wholly inside the other, which is closed
    LeafPair leaves;
};

/// The minimum signed distance of all pairs of a triangle of one mesh and one of the other, mm: of meshes that are
/// apart the distance of their surfaces. The distance of two triangles that cross is negative, the length of the
/// shortest translation that separates the two, so that of two meshes is a lower bound of how deep they are in each
/// other: no translation shorter than it separates them. It changes by no more than the meshes' points move. Accurate
/// to kClearanceAccuracy. A mesh that lies wholly inside a closed one must leave through the nearest point of the
/// surface, as Workpiece::nearest().
/// Both trees are descended together (Gottschalk, Lin & Manocha 1996; Larsen, Gottschalk, Lin & Manocha 1999), eight
/// boxes or triangles at a time in float; what remains possible within rounding is measured in double. FCL does the
/// same for distances, but knows no depth of meshes.
/// @param T_b_a  of the frame of a in that of b
/// @param max_distance  larger distances are reported as this one
/// @param start  NearestTriangles::leaves of a query nearby. It affects the time, and the result only within its
/// accuracy
NearestTriangles nearest_triangles(const Workpiece& a, const Workpiece& b, const Eigen::Isometry3d& T_b_a,
                                   double max_distance, LeafPair start = {});

} // namespace fettle::robot
