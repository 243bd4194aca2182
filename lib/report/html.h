#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fettle {

/// A piece of a page. Text becomes one by being escaped, so nothing that a file holds can turn into markup.
class Html {
  public:
    Html() = default;
    /// Bytes that are no UTF-8, and characters that steer a terminal or turn the direction of text, become U+FFFD.
    Html(std::string_view text);
    Html(const std::string& text) : Html(std::string_view(text)) {}
    Html(const char* text) : Html(std::string_view(text)) {}

    /// What is markup already: style sheets and the like, never anything that was read.
    static Html markup(std::string bytes);

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
/// A symbol with its index, "F_max": what stands after the underscore is set lower.
Html symbol(const std::string& name);
/// <name …/>: of what holds nothing.
Html lone_element(const std::string& name, const Attributes& attributes);

} // namespace fettle
