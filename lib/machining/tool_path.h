#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"
#include "machining/nc_program.h"

#include <optional>
#include <string>

namespace fettle {

/// A cutter's path as it was given: a program, or points.
struct ToolPath {
    NcProgram program;           ///< in the tilted frame; of points only the moves
    std::string text;            ///< of the program
    std::optional<Cloud> points; ///< if there is no program; in the tilted frame
};

struct PointMeaning {
    bool contacts = false; ///< are points where the cutter touches (CC), rather than tips (CL)?
    double feed = 10;      ///< of points without one, mm/s
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(); ///< of the tool, M (tilt.h); a program is in the tilted frame
};

/// Tells by the content which of them it is.
/// @throws InputError as parse_nc_program() and moves_through()
ToolPath parse_tool_path(std::string bytes, const std::string& source, const Cutter& cutter,
                         const PointMeaning& meaning = {});

} // namespace fettle
