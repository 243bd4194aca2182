#pragma once

#include "plan/plan.h"
#include "plan/tool_path.h"

#include <iosfwd>

namespace fettle::plan {

/// Controller of the machine. LinuxCNC turns the head by its C axis and blends corners within a tolerance (G64 P). Grbl
/// has neither: if the wheel's axis is not along X_m, the program stops (M0) for the head to be turned by hand, and its
/// lines are short enough for Grbl's buffer.
enum class GcodeDialect { linuxcnc, grbl };

inline constexpr double kDefaultChordError = 0.005; ///< mm: a twentieth of the finest tolerance in use

/// Writes layer 1 as G-code: the tool points of one covering, in the job's units, frame M. Between passes the tool
/// retracts to the safe height.
/// @param chord_error  largest deviation of straight moves from the path, mm; it is written into the header
void write_gcode(std::ostream& out, const Plan& plan, const ToolPath& path, GcodeDialect dialect,
                 double chord_error = kDefaultChordError);

} // namespace fettle::plan
