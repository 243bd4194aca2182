#pragma once

#include "units/units.h"

namespace fettle::json {

class Reader;
class Value;

/// The member "units" of a document of lengths alone, {"length": "mm"}, and of one with forces, {"length": "mm",
/// "force": "N"}.
Value to_json(Units::Length length);
Value to_json(const Units& units);

/// Of the member "units" of a document of lengths alone: mm, in or m.
/// @throws InputError if it is missing or says something else
Units::Length read_length_unit(Reader& document);

} // namespace fettle::json
