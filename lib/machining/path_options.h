#pragma once

#include "cli/tool.h"
#include "machining/tool_path.h"

#include <string>

namespace fettle::machining {

/// The command-line options about the path of a cutter.
struct ToolPathOptions {
    explicit ToolPathOptions(cli::Tool& tool);

    bool contacts() const { return points == "cc"; }
    Eigen::Vector3d axis() const;
    /// Reads the path in a file. @throws InputError
    ToolPath read(const std::string& file, const Cutter& cutter) const;

    const std::string& points;    ///< --points
    const std::string& axis_text; ///< --axis
    const double& feed;           ///< --feed, mm/s
    const std::string& start;     ///< --start; empty: not known
};

/// Parses the value of --cutter. @throws InputError that names the option
Cutter parse_cutter_option(const std::string& text);

} // namespace fettle::machining
