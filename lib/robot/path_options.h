#pragma once

#include "cli/tool.h"
#include "robot/solve_path.h"

#include <string>

namespace fettle::robot {

/// The command-line options for the kinematics of a path.
struct PathOptions {
    explicit PathOptions(cli::Tool& tool);

    PathArguments arguments() const { return {track, table, start, jump}; }

    const std::string& track; ///< --track
    const std::string& table; ///< --table
    const std::string& start; ///< --start
    const double& jump;       ///< --jump, degrees
};

/// The robot of a command line, and the options of a URDF.
struct RobotOptions {
    explicit RobotOptions(cli::Tool& tool);

    /// Reads the robot; warns of what its file leaves open.
    Robot read() const;

    cli::Tool& tool;
    const std::string& file;
    const std::string& packages; ///< --package
    const std::string& srdf;     ///< --srdf
    const std::string& tip;      ///< --tip
    const std::string& meshes;   ///< --link-meshes
};

} // namespace fettle::robot
