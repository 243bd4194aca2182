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

} // namespace fettle::robot
