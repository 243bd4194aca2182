#pragma once

#include "compare/view.h"
#include "mesh/mesh.h"
#include "robot/externals.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle {

/// A cell as triangles, to be looked at: cell frame.
struct CellScene {
    Mesh mesh;                     ///< corners are not shared
    std::vector<std::size_t> body; ///< of each triangle: numbers of the robot's bodies, then the workpiece, the floor
    std::vector<Eigen::Vector3d> normal; ///< of each triangle, unit; 0 for one without area
};

/// The surface of a convex solid, by its farthest points along directions 3 degrees apart: polytopes exactly, round
/// ones to a thousandth of their radius. In the body's frame.
Mesh solid_mesh(const Solid& solid);

/// @param workpiece, cuboids  in the part's frame; nullptr: none
/// @param floor  side of the squares of a chequered floor at z = 0 beneath everything, mm; 0: none
CellScene cell_scene(const Robot& robot, const Mesh* workpiece, const Mesh* cuboids, const CellJoints& joints,
                     double floor);

/// Numbers that follow the workpiece's: a floor's lighter squares, its darker ones, and cuboids.
inline std::size_t floor_body(const Robot& robot) { return robot.bodies.size() + 1; }
inline std::size_t cuboids_body(const Robot& robot) { return robot.bodies.size() + 3; }

/// Which triangle is seen at each pixel; -1: none.
/// @param depth  of it, z of the view, mm
Eigen::ArrayXXi seen_triangles(const CellScene& scene, const Eigen::Matrix3d& rotation_view_cell, const View& view,
                               Eigen::ArrayXXd& depth);

} // namespace fettle
