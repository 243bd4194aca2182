#pragma once

#include "core/progress.h"
#include "robot/robot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle {

struct ReachStudy {
    Eigen::Matrix3Xd tips; ///< mm, cell frame: centres of cells, x fastest, then y
    Eigen::VectorXd share; ///< of the 26 directions that the tool can have there
};

/// For every cell of a box: with how many of 26 directions of the tool (to the faces, edges and corners of a cube) its
/// tip can stand at the centre, whatever its turn about its axis (steps of 45 degrees) and the track's place (steps of
/// 100 mm, ends included). A table does not matter: it moves the part.
/// @param step  side of the cells, mm; the box is cut into whole ones, of at least one
/// @throws InputError if there would be more than ten million
ReachStudy study_reach(const Robot& robot, const Eigen::AlignedBox3d& box, double step, const Progress& progress = {});

} // namespace fettle
