#include "json/parse.h"

#include "core/content.h"
#include "core/lines.h"
#include "core/wrong_kind.h"

#include <algorithm>
#include <set>
#include <vector>

namespace fettle::json {

using Json = nlohmann::ordered_json;

namespace {

// Deeper than any schema of fettle. A file of 10^5 brackets must be rejected before it uses much memory.
constexpr int kMaxDepth = 32;
// More than any schema has, because members are searched linearly.
constexpr std::size_t kMaxMembers = 1000;

/// Strips the prefix of nlohmann's messages, "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
std::string plain_message(std::string message)
{
    if (const std::size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    for (char& c : message)
        if (c == '\n') c = ' ';
    return message;
}

/// Validates the text before it is parsed into a tree: rejects duplicate keys, deep nesting and malformed JSON. (With a
/// callback of the parser instead, parsing would take time quadratic in the length of an array.)
class Validator : public nlohmann::json_sax<Json> {
  public:
    explicit Validator(const std::string& source) : source_(source) {}

    bool start_object(std::size_t) override
    {
        keys_.emplace_back();
        return descend();
    }
    bool end_object() override
    {
        keys_.pop_back();
        --depth_;
        return true;
    }
    bool start_array(std::size_t) override { return descend(); }
    bool end_array() override
    {
        --depth_;
        return true;
    }
    bool key(string_t& name) override
    {
        check_text(name);
        if (!keys_.back().insert(name).second)
            throw core::InputError(source_, "key " + core::in_quotes(name) + " is duplicated");
        if (keys_.back().size() > kMaxMembers)
            throw core::InputError(source_, "an object of more than " + std::to_string(kMaxMembers) + " members");
        return true;
    }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t& text) override
    {
        check_text(text);
        return true;
    }
    bool binary(binary_t&) override { return true; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override
    {
        throw core::InputError(source_, plain_message(error.what()));
    }

  private:
    /// A zero byte would end the message that quotes the text, and the name of a file.
    void check_text(const std::string& text) const
    {
        if (text.find('\0') != std::string::npos)
            throw core::InputError(source_, core::in_quotes(text) + " contains the character U+0000");
    }

    bool descend()
    {
        if (++depth_ > kMaxDepth)
            throw core::InputError(source_, "nested deeper than " + std::to_string(kMaxDepth) + " levels");
        return true;
    }

    const std::string& source_;
    int depth_ = 0;
    std::vector<std::set<std::string>> keys_; ///< keys of the enclosing objects
};

} // namespace

Json parse_strictly(std::string_view text, const std::string& source)
{
    const std::size_t begin = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (begin == std::string_view::npos) throw core::InputError(source, "empty, expected JSON");
    const std::string_view word = text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
    const bool is_value = std::string_view("\"-0123456789tfn").find(word[0]) != std::string_view::npos &&
                          word.find_first_of(" \t\r\n") == std::string_view::npos;
    if (word[0] != '{' && word[0] != '[' && !is_value) { // another file type
        core::refuse_other_content(text, source, "JSON");
        const std::string_view before = text.substr(0, begin);
        const std::size_t line = before.rfind('\n') + 1; // offset of the line's first byte; 0 for the first line
        throw core::WrongFileType(source, "line " + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) +
                                              ", column " + std::to_string(begin - line + 1) + ": expected JSON, got " +
                                              core::in_quotes(text.substr(begin, text.find('\n', begin) - begin)));
    }
    Validator validator(source);
    Json::sax_parse(text, &validator);
    return Json::parse(text);
}

} // namespace fettle::json
