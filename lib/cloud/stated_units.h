#pragma once

#include "units/units.h"

#include <optional>
#include <string>
#include <string_view>

namespace fettle::cloud {

/// Units in a header comment: `# units in`, `# units in lbf`. The force may be omitted.
struct DeclaredUnits {
    units::Units::Length length = units::Units::Length::mm;
    std::optional<units::Units::Force> force;
};

/// @param comment  text of a line after its '#'   @return  nothing for comments about something else
/// @throws InputError for unknown units; the message has no file name
std::optional<DeclaredUnits> parse_units_comment(std::string_view comment);

/// True for the comment of a file in a job's frame, `# frame job`. @param comment  text of a line after its '#'
bool is_job_frame_comment(std::string_view comment);

/// Units of a file: those declared in it, else those requested, else mm and N.
/// @throws InputError if declared and requested units differ
units::Units resolve_units(const std::optional<DeclaredUnits>& declared, const std::optional<units::Units>& requested,
                           const std::string& source);

} // namespace fettle::cloud
