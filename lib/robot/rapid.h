#pragma once

#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/rates.h"

#include <iosfwd>
#include <string>

namespace fettle::robot {

struct RapidOptions {
    Feedrate feed;
    std::string zone = "z0"; ///< zonedata of the targets between the first and the last
};

/// Writes a path as an ABB RAPID module: robtargets with orientation q1 to q4 = w, x, y, z, configuration and external
/// axes (eax_a the track, mm; eax_b the table, degrees), the tool, and the part's frame as work object. The program
/// moves to the first target by its joints.
/// @param path  all of its poses must be reached
void write_rapid(std::ostream& out, const Robot& robot, const cloud::PosePath& poses, const FollowedPath& path,
                 const RapidOptions& options);

/// RAPID's confdata (ABB, RAPID reference manual, "confdata"; its table of cfx is repeated in AXIS_CONFIGURATION.md of
/// github.com/CEAD-group/py-opw-kinematics): the quadrants of joints 1, 4 and 6 (0: 0 to 90 degrees, -1: -90 to 0, …),
/// and for serial arms the branch: 4 if the wrist centre lies behind axis 1, + 2 if it lies behind the lower arm, + 1
/// if joint 5 is negative. It is 0 with a parallelogram, where controllers determine the branch from the quadrants.
Eigen::Vector4i rapid_configuration(const Robot& robot, const Joints& joints);

} // namespace fettle::robot
