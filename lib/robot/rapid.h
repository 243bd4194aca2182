#pragma once

#include "robot/externals.h"
#include "robot/follow.h"
#include "robot/rates.h"

#include <iosfwd>
#include <string>

namespace fettle {

struct RapidOptions {
    Feedrate feed;
    std::string zone = "z0";
};

/// A path as an ABB RAPID module: robtargets with orientation q1 to q4 = w, x, y, z, configuration and external axes
/// (eax_a the track, mm; eax_b the table, degrees), the tool, and the part's frame as work object. The first target is
/// reached by its joints.
/// @param path  all of its poses reached
void write_rapid(std::ostream& out, const Robot& robot, const PosePath& poses, const FollowedPath& path,
                 const RapidOptions& options);

/// RAPID's confdata (ABB, RAPID reference manual, "confdata"; its table of cfx is repeated in AXIS_CONFIGURATION.md of
/// github.com/CEAD-group/py-opw-kinematics): the quadrants of joints 1, 4 and 6 (0: 0 to 90 degrees, -1: -90 to 0, …),
/// and for serial arms which of eight ways the pose is reached: 4 if the wrist centre lies behind axis 1, + 2 if it
/// lies behind the lower arm, + 1 if joint 5 is negative; 0 with a parallelogram, which controllers know by its
/// quadrants.
Eigen::Vector4i rapid_configuration(const Robot& robot, const Joints& joints);

} // namespace fettle
