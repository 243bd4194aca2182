#include "cloud/stated_units.h"

#include "core/error.h"
#include "core/lines.h"

namespace fettle::cloud {

std::optional<DeclaredUnits> parse_units_comment(std::string_view comment)
{
    const std::vector<std::string_view> parts = core::words(comment);
    if (parts.empty() || parts[0] != "units") return std::nullopt;
    if (parts.size() != 2 && parts.size() != 3)
        throw core::InputError("expected '# units LENGTH [FORCE]', got " + core::in_quotes("#" + std::string(comment)));
    DeclaredUnits units;
    units.length = units::parse_length_unit(std::string(parts[1]));
    if (parts.size() == 3) units.force = units::parse_force_unit(std::string(parts[2]));
    return units;
}

bool is_job_frame_comment(std::string_view comment)
{
    const std::vector<std::string_view> parts = core::words(comment);
    return parts.size() == 2 && parts[0] == "frame" && parts[1] == "job";
}

units::Units resolve_units(const std::optional<DeclaredUnits>& declared, const std::optional<units::Units>& requested,
                           const std::string& source)
{
    units::Units units = requested.value_or(units::Units{});
    if (!declared) return units;
    if (requested && declared->length != requested->length)
        throw core::InputError(source, "units: the file says " + units::to_string(declared->length) + ", expected " +
                                           units::to_string(requested->length));
    if (requested && declared->force && *declared->force != requested->force)
        throw core::InputError(source, "units: the file says " + units::to_string(*declared->force) + ", expected " +
                                           units::to_string(requested->force));
    units.length = declared->length;
    units.force = declared->force.value_or(units.force);
    return units;
}

} // namespace fettle::cloud
