#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"
#include "machining/nc_program.h"

#include <optional>
#include <string>

namespace fettle::machining {

/// The path of a cutter from a file: an NC program, or points.
struct ToolPath {
    NcProgram program;                  ///< in the tilted frame (tilt.h); for points only its moves are set
    std::string text;                   ///< text of the program
    std::optional<cloud::Cloud> points; ///< set if the file has points; in the tilted frame
};

/// Interpretation of a path.
struct ToolPathReading {
    bool contacts = false; ///< of points: true: cutter contacts (CC); false: cutter locations (CL)
    double feed = 10;      ///< of points without one, mm/s
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(); ///< tool axis, frame M (tilt.h); programs are in the tilted frame
    std::optional<Eigen::Vector3d> start = {};       ///< of a program: the tip before its first move, mm
};

/// Parses a program or points, depending on the content.
/// @throws InputError as parse_nc_program() and moves_through()
ToolPath parse_tool_path(std::string bytes, const std::string& source, const Cutter& cutter,
                         const ToolPathReading& options = {});

} // namespace fettle::machining
