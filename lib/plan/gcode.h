#pragma once

#include "plan/plan.h"
#include "plan/tool_path.h"

#include <iosfwd>

namespace fettle {

/// Layer 1 as G-code: tool points of the whole covering, in the job's units. Between two passes it goes up to the safe
/// height. Straight moves stay within `chord_error` (mm) of the path; it stands in the header.
inline constexpr double kChordError = 0.005; // a twentieth of the finest tolerance in use
void write_gcode(std::ostream& out, const Plan& plan, const ToolPath& path, double chord_error = kChordError);

} // namespace fettle
