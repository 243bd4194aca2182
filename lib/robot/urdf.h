#pragma once

#include "robot/robot.h"

#include <map>
#include <string>
#include <string_view>

namespace fettle::robot {

/// What a URDF leaves open.
struct UrdfOptions {
    std::map<std::string, std::string> packages; ///< folders of the packages that package:// names
    std::string srdf;                            ///< file of pairs of links that may touch; empty: none
    std::string tip;                             ///< link whose frame is the tool's; empty: tool0, else the last link
    bool exact_meshes = true;                    ///< meshes of links count triangle by triangle; false: their hulls
};

/// Parses "NAME=DIR,NAME=DIR". @throws InputError for anything else
std::map<std::string, std::string> parse_packages(const std::string& text);

/// True for the text of an XML file.
bool looks_like_xml(std::string_view text);

/// A robot described in URDF: the six revolute joints from its root to the tip, before them perhaps a prismatic one,
/// the track; limits and speeds; the collision shapes of all links as bodies. Its root is the cell. Frame 6 is at axis
/// 6, the tip's frame becomes the tool's, whose z points out of the robot. A closed form is used where the axes have
/// one (ArmKind). Joints off this chain stay at 0; a mimic joint is named in Robot::notes. Reading is liburdfdom's;
/// meshes are read as all meshes.
/// @param source  name of the file; meshes without a package are relative to its folder
/// @throws InputError for a xacro file, a file that liburdfdom refuses, loops, another number of joints, joints without
/// limits or axis, and meshes that are missing or of another format
Robot parse_urdf(const std::string& text, const std::string& source, const UrdfOptions& options);

} // namespace fettle::robot
