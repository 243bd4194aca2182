#pragma once

#include "cloud/cloud.h"
#include "core/progress.h"
#include "robot/robot.h"
#include "json/document.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle::robot {

struct ReachStudy {
    Eigen::Matrix3Xd tips;         ///< centres of the boxes, mm, cell frame; x varies fastest, then y
    Eigen::VectorXd reached_share; ///< fraction of the 26 directions that the tool can have there, 0 to 1
};

/// Divides a box into small ones and finds for the centre of each how many of 26 directions of the tool (to the faces,
/// edges and corners of a cube) the robot can reach with the tip there, with any turn of the tool about its axis (steps
/// of 45 degrees) and any position of the track (steps of 100 mm, ends included). A table does not matter: it moves the
/// part.
/// @param step  largest side of the small boxes, mm
/// @throws InputError for more than ten million small boxes
ReachStudy compute_reach(const Robot& robot, const Eigen::AlignedBox3d& box, double step,
                         const core::Progress& progress = {});

/// A point for each small box, with the field reach.
cloud::Cloud to_cloud(const ReachStudy& study);
/// Number of small boxes, the fractions that are reached from any and from all directions, and the mean.
json::Value to_json(const ReachStudy& study);

/// Parses the value of --box, "x0,y0,z0,x1,y1,z1". @param mm  in its length unit   @throws InputError
Eigen::AlignedBox3d parse_reach_box(const std::string& text, double mm);

} // namespace fettle::robot
