#pragma once

#include "draw/view.h"
#include "mesh/mesh.h"
#include "robot/externals.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::robot {

/// A cell as triangles for drawing, cell frame, mm.
struct CellScene {
    mesh::Mesh mesh;                     ///< triangles do not share vertices
    std::vector<std::size_t> body;       ///< by triangle: index in Robot::bodies, or one of the indices after them
    std::vector<Eigen::Vector3d> normal; ///< by triangle, unit; 0 for a triangle without area
};

/// The surface of a convex solid from its support points along directions 3 degrees apart, body frame, mm: polytopes
/// exactly, round ones to a thousandth of their radius; triangles as they are.
mesh::Mesh solid_mesh(const Solid& solid);

/// The cell with all bodies at some joints.
/// @param workpiece, cuboids  in the part's frame; nullptr: none
/// @param floor  side of the squares of a chequered floor at z = 0 beneath everything, mm; 0: no floor
CellScene make_cell_scene(const Robot& robot, const mesh::Mesh* workpiece, const mesh::Mesh* cuboids,
                          const CellJoints& joints, double floor);

/// Body indices after the workpiece's, bodies.size(): the lighter squares of the floor (the darker ones are the next
/// index) and the cuboids.
inline std::size_t floor_body(const Robot& robot) { return robot.bodies.size() + 1; }
inline std::size_t cuboids_body(const Robot& robot) { return robot.bodies.size() + 3; }

/// Index of the triangle that is visible at each pixel; -1: none.
/// @param depth  output: z of the visible point in the view's frame, mm; NaN: none
Eigen::ArrayXXi visible_triangles(const CellScene& scene, const Eigen::Matrix3d& rotation_view_cell,
                                  const draw::View& view, Eigen::ArrayXXd& depth);

} // namespace fettle::robot
