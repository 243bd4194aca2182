#include "core/fixed_text.h"

#include <array>
#include <charconv>

namespace fettle::core {

std::string to_fixed_text(double value, int digits)
{
    std::array<char, 400> text; // the largest double has 309 digits
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, digits).ptr;
    std::string result(text.data(), end);
    if (result.find('.') != std::string::npos) {
        result.erase(result.find_last_not_of('0') + 1);
        if (result.back() == '.') result.pop_back();
    }
    return result == "-0" ? "0" : result;
}

} // namespace fettle::core
