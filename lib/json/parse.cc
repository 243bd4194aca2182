#include "json/parse.h"

#include "core/lines.h"
#include "core/wrong_kind.h"

#include <algorithm>
#include <set>
#include <vector>

namespace fettle::json {

using Json = nlohmann::ordered_json;

namespace {

// Deeper than any of our schemas; a file of 10^5 brackets must not cost memory before it is refused.
constexpr int kMaxDepth = 32;
// More than of any of them, too: members are sought one after the other.
constexpr std::size_t kMostMembers = 1000;

// nlohmann's messages read "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
std::string plain_message(std::string message)
{
    if (const std::size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    for (char& c : message)
        if (c == '\n') c = ' ';
    return message;
}

// Looks through the text before a tree is made of it: refuses repeated keys, deep nesting and what is no JSON. (A
// callback of the parser could do so, too, but with one it takes a time that grows as the square of an array's length.)
class Strictness : public nlohmann::json_sax<Json> {
  public:
    explicit Strictness(const std::string& source) : source_(source) {}

    bool start_object(std::size_t) override
    {
        keys_.emplace_back();
        return go_deeper();
    }
    bool end_object() override
    {
        keys_.pop_back();
        --depth_;
        return true;
    }
    bool start_array(std::size_t) override { return go_deeper(); }
    bool end_array() override
    {
        --depth_;
        return true;
    }
    bool key(string_t& name) override
    {
        if (!keys_.back().insert(name).second) throw InputError(source_, "key " + in_quotes(name) + " stands twice");
        if (keys_.back().size() > kMostMembers)
            throw InputError(source_, "an object of more than " + std::to_string(kMostMembers) + " members");
        return true;
    }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override
    {
        throw InputError(source_, plain_message(error.what()));
    }

  private:
    bool go_deeper()
    {
        if (++depth_ > kMaxDepth)
            throw InputError(source_, "nested deeper than " + std::to_string(kMaxDepth) + " levels");
        return true;
    }

    const std::string& source_;
    int depth_ = 0;
    std::vector<std::set<std::string>> keys_; ///< of the objects that are open
};

} // namespace

Json parse_strictly(std::string_view text, const std::string& source)
{
    const std::size_t begin = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (begin == std::string_view::npos) throw InputError(source, "empty, expected JSON");
    const std::string_view word = text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
    const bool is_value = std::string_view("\"-0123456789tfn").find(word[0]) != std::string_view::npos &&
                          word.find_first_of(" \t\r\n") == std::string_view::npos;
    if (word[0] != '{' && word[0] != '[' && !is_value) { // another kind of file
        const std::string_view before = text.substr(0, begin);
        const std::size_t line = before.rfind('\n') + 1; // where it begins; of the first, 0
        throw WrongKind(source, "line " + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) +
                                    ", column " + std::to_string(begin - line + 1) + ": expected JSON, got " +
                                    in_quotes(text.substr(begin, text.find('\n', begin) - begin)));
    }
    Strictness strictness(source);
    Json::sax_parse(text, &strictness);
    return Json::parse(text);
}

} // namespace fettle::json
