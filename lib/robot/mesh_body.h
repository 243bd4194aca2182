#pragma once

#include "mesh/mesh.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

namespace fettle::robot {

/// A body of triangles, convex or not: its surface for distances of every triangle, and its convex hull for what only
/// needs to lie around it.
struct MeshBody {
    /// @param triangles  in the body's frame, mm
    explicit MeshBody(mesh::Mesh triangles);

    const mesh::Mesh mesh;
    const Workpiece surface;
    const Eigen::Matrix3Xd hull; ///< hull_points() of the mesh
};

} // namespace fettle::robot
