#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace fettle {

/// Walks over the lines of a text that was read whole; LF or CRLF ends a line, the last one may lack it.
class Lines {
  public:
    explicit Lines(std::string_view text, std::size_t lines_before = 0) : text_(text), number_(lines_before) {}

    /// Steps to the next line. @return  is there one?
    bool next();
    std::string_view line() const { return line_; }  ///< without its end
    std::size_t number() const { return number_; }   ///< of the line, from 1
    std::size_t offset() const { return position_; } ///< of the first byte after the line
    std::string place() const { return "line " + std::to_string(number_); }

  private:
    std::string_view text_;
    std::string_view line_;
    std::size_t position_ = 0;
    std::size_t number_ = 0;
};

/// Walks over the words of a line, which blanks and tabs separate. @return  the next word; empty at the end
std::string_view next_word(std::string_view& rest);
std::vector<std::string_view> words(std::string_view line);

/// Digits and nothing else around them, a minus before them if it is signed; otherwise, or if the type does not hold
/// the number, nothing.
template <typename Whole>
std::optional<Whole> parse_whole(std::string_view text)
{
    Whole value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// Text from a file as a message may quote it: in quotes, shortened, unprintable bytes replaced.
std::string in_quotes(std::string_view text);

/// Refuses texts that are no ASCII or UTF-8: UTF-16 by its mark or its zero bytes. Removes a UTF-8 byte order mark.
/// @throws InputError
std::string_view without_mark(std::string_view bytes, const std::string& source);

} // namespace fettle
