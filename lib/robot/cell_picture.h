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

namespace fettle {

struct CellPictureOptions {
    std::vector<std::size_t> at;                                     ///< poses, a row of the sheet each
    Eigen::Vector3d from = Eigen::Vector3d(1, -1, 0.8).normalized(); ///< unit, cell frame: towards the eye
    double tolerance = 0.01;                                         ///< as CollisionOptions
    Units units;                                                     ///< of the numbers in the picture
    const Heterogeneous* model = nullptr; ///< the workpiece is drawn as it counts: triangles beneath the tool, cuboids
};

/// The cell with arm, tool, fixtures and part as it stands at some poses: beside each the surroundings of the tool,
/// with the path. Bodies that collide are red, and the place is marked. Light from the upper left; the squares of the
/// floor have sides of 500 mm.
/// @param workpiece  in the part's frame; nullptr: none
/// @param joints, checked  of the whole path, as in check_path()
/// @return the bytes of a PNG, the same for the same input
/// @throws InputError for a pose that the path does not have, or that is not reached
std::string cell_picture(const Robot& robot, const Mesh* workpiece, const CellJointsPath& joints,
                         const CheckedPath& checked, const CellPictureOptions& options);

/// The least clearances at the poses of a path and between them, over the poses' numbers, and what was changed of it.
/// @param before, changes  of a path that was led around collisions: the clearances it had are drawn, too, and the
/// tilts beneath; nullptr: it was not
/// @return the bytes of a PNG
std::string clearance_chart(const CheckedPath& checked, const CheckedPath* before,
                            const std::vector<PoseChange>* changes, const Units& units);

} // namespace fettle
