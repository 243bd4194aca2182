#include "json/leaves.h"

#include "core/text.h"
#include "json/parse.h"

namespace fettle::json {

namespace {

using Json = nlohmann::ordered_json;

void collect(const Json& json, const std::string& path, std::vector<Leaf>& found)
{
    if (json.is_structured() && json.empty()) {
        found.push_back({path, Leaf::Empty{json.is_object()}});
    } else if (json.is_object()) {
        for (const auto& member : json.items())
            collect(member.value(), path.empty() ? member.key() : path + "." + member.key(), found);
    } else if (json.is_array()) {
        for (std::size_t i = 0; i < json.size(); ++i) collect(json[i], path + "[" + std::to_string(i) + "]", found);
    } else if (json.is_number()) {
        found.push_back({path, json.get<double>()});
    } else if (json.is_string()) {
        found.push_back({path, json.get<std::string>()});
    } else if (json.is_boolean()) {
        found.push_back({path, json.get<bool>()});
    } else {
        found.push_back({path, nullptr});
    }
}

} // namespace

std::vector<Leaf> flatten(std::string_view text, const std::string& source)
{
    std::vector<Leaf> found;
    collect(parse_strictly(text, source), "", found);
    return found;
}

std::string to_text(const Leaf& leaf)
{
    if (const double* number = std::get_if<double>(&leaf.value)) return fettle::core::to_text(*number);
    if (const std::string* text = std::get_if<std::string>(&leaf.value)) return '"' + *text + '"';
    if (const bool* flag = std::get_if<bool>(&leaf.value)) return *flag ? "true" : "false";
    if (const Leaf::Empty* empty = std::get_if<Leaf::Empty>(&leaf.value)) return empty->object ? "{}" : "[]";
    return "null";
}

} // namespace fettle::json
