#include "json/units.h"

#include "json/document.h"

namespace fettle::json {

Value to_json(units::Units::Length length) { return Value().set("length", units::to_string(length)); }

Value to_json(const units::Units& units) { return to_json(units.length).set("force", units::to_string(units.force)); }

units::Units::Length read_length_unit(Reader& document)
{
    Reader units = document.object("units");
    const units::Units::Length length = units::parse_length_unit(units.choice("length", {"mm", "in", "m"}));
    units.reject_unknown_keys();
    return length;
}

} // namespace fettle::json
