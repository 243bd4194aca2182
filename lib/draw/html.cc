#include "draw/html.h"

namespace fettle::draw {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD"; // U+FFFD

/// Length in bytes of the UTF-8 character at the beginning of `text` (RFC 3629, table 3-7 of Unicode); 0: invalid.
std::size_t character_size(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const auto continues = [&](std::size_t i, unsigned min = 0x80, unsigned max = 0xBF) {
        return byte(i) >= min && byte(i) <= max;
    };
    const unsigned lead = byte(0);
    if (lead < 0x80) return 1;
    if (lead >= 0xC2 && lead <= 0xDF) return continues(1) ? 2 : 0;
    if (lead >= 0xE0 && lead <= 0xEF)
        return continues(1, lead == 0xE0 ? 0xA0 : 0x80, lead == 0xED ? 0x9F : 0xBF) && continues(2) ? 3 : 0;
    if (lead >= 0xF0 && lead <= 0xF4)
        return continues(1, lead == 0xF0 ? 0x90 : 0x80, lead == 0xF4 ? 0x8F : 0xBF) && continues(2) && continues(3) ? 4
                                                                                                                    : 0;
    return 0;
}

/// Whether it is a control character or changes the direction of text (U+202A to U+202E, U+2066 to U+2069).
bool is_control(std::string_view character)
{
    if (character.size() == 1) {
        const unsigned char c = static_cast<unsigned char>(character[0]);
        return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7F;
    }
    if (character.size() == 2) return character >= "\xC2\x80" && character <= "\xC2\x9F";
    return (character >= "\xE2\x80\xAA" && character <= "\xE2\x80\xAE") ||
           (character >= "\xE2\x81\xA6" && character <= "\xE2\x81\xA9");
}

/// Whether Unicode reserves it for no character ever (U+FDD0 to U+FDEF, and the last two of each plane): XML and HTML
/// forbid most of them.
bool is_noncharacter(std::string_view character)
{
    if (character.size() == 3 && character >= "\xEF\xB7\x90" && character <= "\xEF\xB7\xAF") return true;
    if (character.size() < 3 || !(character.ends_with("\xBF\xBE") || character.ends_with("\xBF\xBF"))) return false;
    const unsigned char before = static_cast<unsigned char>(character[character.size() - 3]);
    return character.size() == 3 ? before == 0xEF : (before & 0x0F) == 0x0F;
}

std::string escaped(std::string_view text)
{
    std::string safe;
    safe.reserve(text.size());
    while (!text.empty()) {
        const std::size_t size = character_size(text);
        const std::string_view character = text.substr(0, size);
        if (size == 0 || is_control(character) || is_noncharacter(character))
            safe += kReplacement;
        else if (character == "&")
            safe += "&amp;";
        else if (character == "<")
            safe += "&lt;";
        else if (character == ">")
            safe += "&gt;";
        else if (character == "\"")
            safe += "&quot;";
        else if (character == "'")
            safe += "&#39;";
        else
            safe += character;
        text.remove_prefix(size == 0 ? 1 : size);
    }
    return safe;
}

std::string opening(const std::string& name, const Attributes& attributes)
{
    std::string bytes = "<" + name;
    for (const auto& [key, value] : attributes) bytes += " " + key + "=\"" + escaped(value) + "\"";
    return bytes;
}

} // namespace

Html::Html(std::string_view text) : bytes_(escaped(text)) {}

Html Html::from_markup(std::string bytes)
{
    Html html;
    html.bytes_ = std::move(bytes);
    return html;
}

Html& Html::operator+=(const Html& other)
{
    bytes_ += other.bytes_;
    return *this;
}

Html element(const std::string& name, const Attributes& attributes, const Html& content)
{
    return Html::from_markup(opening(name, attributes) + ">" + content.bytes() + "</" + name + ">");
}

Html element(const std::string& name, const Html& content) { return element(name, Attributes{}, content); }

Html symbol_with_subscript(const std::string& name)
{
    const std::size_t underscore = name.find('_');
    if (underscore == std::string::npos) return name;
    return Html(name.substr(0, underscore)) + element("sub", name.substr(underscore + 1));
}

Html empty_element(const std::string& name, const Attributes& attributes)
{
    return Html::from_markup(opening(name, attributes) + "/>");
}

} // namespace fettle::draw
