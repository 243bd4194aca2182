#include "cloud/stated_units.h"

#include "core/error.h"
#include "core/lines.h"

namespace fettle {

std::optional<StatedUnits> parse_stated_units(std::string_view comment)
{
    const std::vector<std::string_view> found = words(comment);
    if (found.empty() || found[0] != "units") return std::nullopt;
    if (found.size() != 2 && found.size() != 3)
        throw InputError("expected '# units LENGTH [FORCE]', got " + in_quotes("#" + std::string(comment)));
    StatedUnits units;
    units.length = parse_length_unit(std::string(found[1]));
    if (found.size() == 3) units.force = parse_force_unit(std::string(found[2]));
    return units;
}

Units agreed_units(const std::optional<StatedUnits>& stated, const std::optional<Units>& wanted,
                   const std::string& source)
{
    Units units = wanted.value_or(Units{});
    if (!stated) return units;
    if (wanted && stated->length != wanted->length)
        throw InputError(source, "units: the file says " + to_string(stated->length) + ", expected " +
                                     to_string(wanted->length));
    if (wanted && stated->force && *stated->force != wanted->force)
        throw InputError(source, "units: the file says " + to_string(*stated->force) + ", expected " +
                                     to_string(wanted->force));
    units.length = stated->length;
    units.force = stated->force.value_or(units.force);
    return units;
}

} // namespace fettle
