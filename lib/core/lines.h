#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace fettle::core {

/// Iterates over the lines of a text. LF or CRLF ends a line; the last line may lack it.
class Lines {
  public:
    /// @param lines_before  added to all line numbers
    explicit Lines(std::string_view text, std::size_t lines_before = 0) : text_(text), number_(lines_before) {}

    /// Steps to the next line. @return  false at the end of the text
    bool next();
    std::string_view line() const { return line_; }  ///< without its line end
    std::size_t number() const { return number_; }   ///< number of the line, from 1
    std::size_t offset() const { return position_; } ///< offset of the first byte after the line
    /// "line 12", for messages.
    std::string location() const { return "line " + std::to_string(number_); }

  protected:
    std::string_view text_;

  private:
    std::string_view line_;
    std::size_t position_ = 0;
    std::size_t number_ = 0;
};

/// Lines of a file, as a base of parsers: errors name the file and the line.
class FileLines : public Lines {
  public:
    /// @param source  name of the file; must outlive this object
    FileLines(std::string_view text, const std::string& source, std::size_t lines_before = 0)
        : Lines(text, lines_before), source_(source)
    {
    }

    /// Steps to the next line. @throws InputError if it is longer than `max_bytes`
    bool next_short(std::size_t max_bytes);
    /// @throws InputError "SOURCE: line 12: problem"
    [[noreturn]] void refuse(const std::string& problem) const;

  protected:
    const std::string& source_;
};

/// Removes the next word, which blanks or tabs separate, from the rest of a line. @return  the word; empty at the end
std::string_view next_word(std::string_view& rest);
std::vector<std::string_view> words(std::string_view line);

/// True if the line holds nothing but blanks and tabs.
bool is_blank_line(std::string_view line);
/// True if the line is blank or its first word begins with '#'.
bool is_blank_or_comment(std::string_view line);

/// Parses an integer: digits only, with an optional minus if the type is signed. Returns nothing for other text and for
/// numbers out of range.
template <typename Integer>
std::optional<Integer> parse_integer(std::string_view text)
{
    Integer value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// Quotes text from a file in a message: shortened, with unprintable bytes replaced.
std::string in_quotes(std::string_view text);

/// Removes a UTF-8 byte order mark.
/// @throws InputError for a byte order mark of UTF-16
std::string_view strip_byte_order_mark(std::string_view bytes, const std::string& source);

} // namespace fettle::core
