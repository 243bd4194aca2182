#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fettle::json {

/// A scalar value of a JSON document with its path, "surface.control[3][0]". Empty arrays and objects are leaves, too.
struct Leaf {
    struct Empty {
        bool object = false;
        bool operator==(const Empty&) const = default;
    };
    std::string path;
    std::variant<std::nullptr_t, bool, double, std::string, Empty> value;
};

/// Lists all leaves of a JSON text in document order.
/// @throws InputError if it is not strict JSON
std::vector<Leaf> flatten(std::string_view text, const std::string& source);

/// Text of the value for messages: 0.5, "text", true, null, [].
std::string to_text(const Leaf& leaf);

} // namespace fettle::json
