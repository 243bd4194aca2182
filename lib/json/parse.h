#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace fettle::json {

/// Parses a whole JSON text; repeated keys, deep nesting and numbers out of range are refused. For json/*.cc only.
/// @throws InputError with the line and column, or the key
nlohmann::ordered_json parse_strictly(std::string_view text, const std::string& source);

} // namespace fettle::json
