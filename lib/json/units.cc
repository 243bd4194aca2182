#include "json/units.h"

#include "json/document.h"

namespace fettle::json {

Value to_json(Units::Length length) { return Value().set("length", to_string(length)); }

Value to_json(const Units& units) { return to_json(units.length).set("force", to_string(units.force)); }

Units::Length read_length_unit(Reader& document)
{
    Reader units = document.object("units");
    const Units::Length length = parse_length_unit(units.choice("length", {"mm", "in", "m"}));
    units.done();
    return length;
}

} // namespace fettle::json
