#pragma once

#include "plan/plan.h"
#include "plan/tool_path.h"

#include <iosfwd>

namespace fettle {

/// What a controller understands beyond the words that all share. LinuxCNC turns the head by its C axis and blends
/// corners within a tolerance (G64 P); Grbl has neither: where the wheel's axis does not lie along X_m the program
/// waits (M0) for the head to be turned by hand, and its lines are short enough for the buffer.
enum class GcodeDialect { linuxcnc, grbl };

/// Layer 1 as G-code: tool points of the whole covering, in the job's units, frame M. Between two passes it goes up to
/// the safe height. Straight moves stay within `chord_error` (mm) of the path; it stands in the header.
inline constexpr double kChordError = 0.005; // a twentieth of the finest tolerance in use
void write_gcode(std::ostream& out, const Plan& plan, const ToolPath& path, GcodeDialect dialect,
                 double chord_error = kChordError);

} // namespace fettle
