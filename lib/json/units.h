#pragma once

#include "units/units.h"

namespace fettle::json {

class Reader;
class Value;

/// Value of a document's member "units": {"length": "mm"}, or {"length": "mm", "force": "N"} if it holds forces.
Value to_json(units::Units::Length length);
Value to_json(const units::Units& units);

/// Reads the member "units" of a document without forces: mm, in or m.
/// @throws InputError if it is missing or invalid
units::Units::Length read_length_unit(Reader& document);

} // namespace fettle::json
