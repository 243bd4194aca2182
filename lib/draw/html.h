#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fettle::draw {

/// A fragment of an HTML page. Text is converted by escaping, so that no content of a file can become markup.
class Html {
  public:
    Html() = default;
    /// Invalid UTF-8, control characters, noncharacters (U+FFFF) and those that change the direction of text become
    /// U+FFFD.
    Html(std::string_view text);
    Html(const std::string& text) : Html(std::string_view(text)) {}
    Html(const char* text) : Html(std::string_view(text)) {}

    /// Takes bytes that are markup already, such as style sheets, unescaped: never content of a file.
    static Html from_markup(std::string bytes);

    Html& operator+=(const Html& other);
    friend Html operator+(Html a, const Html& b) { return a += b; }
    bool empty() const { return bytes_.empty(); }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Values are text and are escaped.
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// <name …>content</name>
Html element(const std::string& name, const Attributes& attributes, const Html& content = {});
Html element(const std::string& name, const Html& content);
/// A symbol such as "F_max", with the part after the underscore as subscript.
Html symbol_with_subscript(const std::string& name);
/// <name …/>
Html empty_element(const std::string& name, const Attributes& attributes);

} // namespace fettle::draw
