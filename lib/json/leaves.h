#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fettle::json {

/// One value of a JSON text that holds no others, with its path: "surface.control[3][0]". Arrays and objects without
/// elements are leaves too: "[]", "{}".
struct Leaf {
    struct Empty {
        bool object = false;
        bool operator==(const Empty&) const = default;
    };
    std::string path;
    std::variant<std::nullptr_t, bool, double, std::string, Empty> value;
};

/// All leaves of a JSON text, in its order.
/// @throws InputError if it is no strict JSON
std::vector<Leaf> leaves(std::string_view text, const std::string& source);

/// As it stands in a message: 0.5, "text", true, null, [].
std::string to_text(const Leaf& leaf);

} // namespace fettle::json
