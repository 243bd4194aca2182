#pragma once

#include "cloud/cloud.h"
#include "core/progress.h"
#include "robot/robot.h"
#include "json/document.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace fettle::robot {

/// What keeps the tip from a place, or leaves it.
enum class ReachLimit : std::uint8_t {
    none,         ///< it is reached, and with some of the joints that reach it nothing touches anything
    collision,    ///< it is reached, but always with a collision
    joint_ranges, ///< the arm is long enough, but its joints do not turn far enough
    length        ///< the arm is too short, or too long
};

struct ReachStudy {
    Eigen::Matrix3Xd tips;         ///< centres of the boxes, mm, cell frame; x varies fastest, then y
    Eigen::VectorXd reached_share; ///< fraction of the 26 directions that the tool can have there, 0 to 1
    std::vector<ReachLimit> limits;
    /// By place, of those that joint ranges limit: bit k is set where the range of joint k + 1 alone does.
    std::vector<std::uint8_t> single_joints;
};

/// Divides a box into small ones and finds for the centre of each how many of 26 directions of the tool (to the faces,
/// edges and corners of a cube) the robot can reach with the tip there, with any turn of the tool about its axis (steps
/// of 45 degrees) and any position of the track (steps of 100 mm, ends included). A table does not matter: it moves the
/// part; what is on it counts as it stands at 0. Collisions are looked for with one turn of the tool for each direction
/// and position of the track.
/// @param step  largest side of the small boxes, mm
/// @throws InputError for more than ten million small boxes
ReachStudy compute_reach(const Robot& robot, const Eigen::AlignedBox3d& box, double step,
                         const core::Progress& progress = {});

/// A point for each small box, with the field reach.
cloud::Cloud to_cloud(const ReachStudy& study);
/// Number of small boxes, the fractions that are reached from any and from all directions, and the mean; and the
/// fractions by their limits.
json::Value to_json(const ReachStudy& study);

/// Parses the value of --box, "x0,y0,z0,x1,y1,z1". @param mm  in its length unit   @throws InputError
Eigen::AlignedBox3d parse_reach_box(const std::string& text, double mm);

} // namespace fettle::robot
