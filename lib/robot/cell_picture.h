#pragma once

#include "mesh/mesh.h"
#include "robot/collision.h"
#include "robot/externals.h"
#include "robot/robot.h"
#include "robot/tilt.h"
#include "units/units.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace fettle::robot {

struct CellPictureOptions {
    std::vector<std::size_t> poses;                                         ///< poses to draw, each a row of the sheet
    Eigen::Vector3d towards_eye = Eigen::Vector3d(1, -1, 0.8).normalized(); ///< unit, cell frame: towards the viewer
    double tolerance = 0.01;                                                ///< CollisionOptions::tolerance, mm
    units::Units units;                                                     ///< of the numbers in the picture
    const HeterogeneousModel* model =
        nullptr; ///< if given, the workpiece is drawn as its triangles under the tool and cuboids
};

/// Draws the cell with arm, tool, fixtures, part and path at some poses, each as a whole and around the tool. Bodies
/// that collide are red, and the nearest or deepest point is marked. The legend names what is drawn. The squares of the
/// floor have sides of 500 mm.
/// @param workpiece  in the part's frame; nullptr: none
/// @param joints, checked  of the whole path, see check_path()
/// @return  the bytes of a PNG, the same for the same input
/// @throws InputError for a pose that the path does not have, or that is not reached
std::string draw_cell_picture(const Robot& robot, const mesh::Mesh* workpiece, const CellJointsPath& joints,
                              const CheckedPath& checked, const CellPictureOptions& options);

/// Draws the minimum clearances at the poses of a path and between them, over the index of the pose.
/// @param before, changes  for a path on which collisions were avoided: its clearances before and its changes, drawn as
///                         further curves and as a chart of the tilts; nullptr: not drawn
/// @return  the bytes of a PNG
std::string draw_clearance_chart(const CheckedPath& checked, const CheckedPath* before,
                                 const std::vector<PoseChange>* changes, double tolerance, const units::Units& units);

} // namespace fettle::robot
