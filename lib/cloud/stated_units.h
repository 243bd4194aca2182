#pragma once

#include "units/units.h"

#include <optional>
#include <string>
#include <string_view>

namespace fettle {

/// Units that a header names: `# units in`, `# units in lbf`. The force may be left out.
struct StatedUnits {
    Units::Length length = Units::Length::mm;
    std::optional<Units::Force> force;
};

/// @param comment  a line's text after its '#'   @return  nothing if it is about something else
/// @throws InputError for units that there are not; the message has no file name
std::optional<StatedUnits> parse_stated_units(std::string_view comment);

/// The units of a file: what it states, else what is wanted, else mm and N.
/// @throws InputError if the two disagree
Units agreed_units(const std::optional<StatedUnits>& stated, const std::optional<Units>& wanted,
                   const std::string& source);

} // namespace fettle
