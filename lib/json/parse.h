#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace fettle::json {

/// Parses a JSON text strictly: rejects duplicate keys, deep nesting and numbers out of range. Internal to json/*.cc.
/// @throws InputError with the line and column, or the key
nlohmann::ordered_json parse_strictly(std::string_view text, const std::string& source);

} // namespace fettle::json
