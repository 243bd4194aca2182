#include "core/lines.h"

#include "core/error.h"

#include <algorithm>

namespace fettle::core {

bool Lines::next()
{
    if (position_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    position_ = std::min(end + 1, text_.size());
    ++number_;
    return true;
}

bool FileLines::next_short(std::size_t max_bytes)
{
    if (!next()) return false;
    if (line().size() > max_bytes) refuse("longer than " + std::to_string(max_bytes) + " bytes");
    return true;
}

void FileLines::refuse(const std::string& problem) const { throw InputError(source_, location() + ": " + problem); }

constexpr std::string_view kBlanks = " \t";

bool is_blank_line(std::string_view line) { return line.find_first_not_of(kBlanks) == std::string_view::npos; }

bool is_blank_or_comment(std::string_view line) { return is_blank_line(line) || next_word(line).starts_with('#'); }

std::string_view next_word(std::string_view& rest)
{
    const std::size_t first = rest.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return rest = {};
    const std::size_t end = std::min(rest.find_first_of(kBlanks, first), rest.size());
    const std::string_view word = rest.substr(first, end - first);
    rest.remove_prefix(end);
    return word;
}

std::vector<std::string_view> words(std::string_view line)
{
    std::vector<std::string_view> found;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) found.push_back(word);
    return found;
}

std::string in_quotes(std::string_view text)
{
    constexpr std::size_t kMaxQuotation = 40; // keeps a message one readable line
    std::string quotation = "'";
    for (const char c : text.substr(0, kMaxQuotation)) quotation += c >= ' ' && c != '\x7f' ? c : '?';
    if (text.size() > kMaxQuotation) quotation += "...";
    return quotation + "'";
}

std::string_view strip_byte_order_mark(std::string_view bytes, const std::string& source)
{
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
        throw InputError(source, "byte 1: text in UTF-16, expected ASCII or UTF-8");
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    return bytes;
}

} // namespace fettle::core
