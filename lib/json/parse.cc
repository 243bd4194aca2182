#include "json/parse.h"

#include "core/error.h"
#include "core/lines.h"

#include <algorithm>
#include <set>
#include <vector>

namespace fettle::json {

using Json = nlohmann::ordered_json;

namespace {

// Deeper than any of our schemas; a file of 10^5 brackets must not cost memory before it is refused.
constexpr int kMaxDepth = 32;

// Parser callback: refuses repeated keys and deep nesting while the text is read.
class Strictness {
  public:
    explicit Strictness(const std::string& source) : source_(source) {}

    bool operator()(int depth, Json::parse_event_t event, Json& parsed)
    {
        using Event = Json::parse_event_t;
        if (depth > kMaxDepth) throw InputError(source_, "nested deeper than " + std::to_string(kMaxDepth) + " levels");
        if (event == Event::object_start) keys_.emplace_back();
        if (event == Event::object_end) keys_.pop_back();
        if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second)
            throw InputError(source_, "key " + in_quotes(parsed.get<std::string>()) + " stands twice");
        return true;
    }

  private:
    const std::string& source_;
    std::vector<std::set<std::string>> keys_;
};

// nlohmann's messages read "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
std::string plain_message(std::string message)
{
    if (const std::size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    for (char& c : message)
        if (c == '\n') c = ' ';
    return message;
}

} // namespace

Json parse_strictly(std::string_view text, const std::string& source)
{
    const std::size_t begin = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (begin == std::string_view::npos) throw InputError(source, "empty, expected JSON");
    if (std::string_view("{[\"-0123456789tfn").find(text[begin]) == std::string_view::npos) { // another kind of file
        const std::string_view before = text.substr(0, begin);
        const std::size_t line = before.rfind('\n') + 1; // where it begins; of the first, 0
        throw InputError(source, "line " + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) +
                                     ", column " + std::to_string(begin - line + 1) + ": expected JSON, got " +
                                     in_quotes(text.substr(begin, text.find('\n', begin) - begin)));
    }
    try {
        return Json::parse(text, Strictness(source));
    } catch (const Json::exception& error) {
        throw InputError(source, plain_message(error.what()));
    }
}

} // namespace fettle::json
