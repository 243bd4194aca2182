#include "json/document.h"

#include "core/file.h"
#include "core/text.h"
#include "core/wrong_kind.h"
#include "json/parse.h"

#include <cmath>
#include <limits>
#include <set>

namespace fettle::json {

using Json = nlohmann::ordered_json;

namespace {

std::string type_of(const Json& json)
{
    return json.is_null()      ? "null"
           : json.is_boolean() ? "true or false"
           : json.is_number()  ? "a number"
           : json.is_string()  ? "text"
           : json.is_array()   ? "an array"
                               : "an object";
}

} // namespace

struct Reader::Node {
    std::shared_ptr<const Json> document; ///< keeps the whole tree alive
    const Json* json;
    std::set<std::string> asked;
};

Reader::Reader(std::shared_ptr<Node> node, std::string source, std::string path)
    : node_(std::move(node)), source_(std::move(source)), path_(std::move(path))
{
}

namespace {

// So that a message stays one readable line.
std::string shortened(const std::string& text)
{
    constexpr std::size_t kLongest = 100;
    std::string line = text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
    for (char& c : line)
        if ((c >= '\0' && c < ' ') || c == '\x7f') c = '?';
    return line;
}

double any_number(const Reader& reader, const Json& json, const std::string& place)
{
    if (!json.is_number()) reader.refuse(place, "expected a number, got " + type_of(json));
    return json.get<double>();
}

double number_of(const Reader& reader, const Json& json, const std::string& place)
{
    constexpr double kLargest = 1e100; // stands for nothing, and its square or a change of unit would overflow
    const double value = any_number(reader, json, place);
    if (std::abs(value) > kLargest) reader.refuse(place, "no number may be as large as " + to_text(value));
    return value;
}

} // namespace

Reader Reader::open(const std::string& path) { return parse(read_whole(path, kMostJson), display_name(path)); }

Reader Reader::parse(std::string_view text, const std::string& source)
{
    const auto document = std::make_shared<const Json>(parse_strictly(text, source));
    if (!document->is_object()) throw InputError(source, "expected a JSON object, got " + type_of(*document));
    return {std::make_shared<Node>(Node{document, document.get(), {}}), source, ""};
}

std::string Reader::path_of(const std::string& key) const
{
    return path_.empty() ? key : key.empty() ? path_ : path_ + "." + key;
}

void Reader::refuse(const std::string& key, const std::string& problem) const
{
    const std::string path = shortened(path_of(key));
    throw InputError(source_, path.empty() ? problem : path + ": " + problem);
}

bool Reader::has(const std::string& key) const { return node_->json->contains(key); }

const Json& Reader::member(const std::string& key, const char* wanted)
{
    node_->asked.insert(key);
    const auto found = node_->json->find(key);
    if (found == node_->json->end()) refuse(key, std::string("missing, expected ") + wanted);
    return *found;
}

void Reader::expect_kind(const std::string& kind)
{
    const std::string got = text("kind");
    if (got != kind)
        throw WrongKind(source_, path_of("kind") + ": expected \"" + kind + "\", got \"" + shortened(got) + "\"");
}

double Reader::number(const std::string& key, const Range& range)
{
    const double value = number_of(*this, member(key, "a number"), key);
    if (!range.contains(value)) refuse(key, "must be " + range.text() + ", got " + to_text(value));
    return value;
}

double Reader::number_or(const std::string& key, double otherwise, const Range& range)
{
    node_->asked.insert(key);
    return has(key) ? number(key, range) : otherwise;
}

int Reader::integer(const std::string& key, int least, int most)
{
    const double value = number(key, Range::between(least, most));
    if (value != std::floor(value)) refuse(key, "must be a whole number, got " + to_text(value));
    return static_cast<int>(value);
}

bool Reader::flag_or(const std::string& key, bool otherwise)
{
    node_->asked.insert(key);
    if (!has(key)) return otherwise;
    const Json& json = member(key, "true or false");
    if (!json.is_boolean()) refuse(key, "expected true or false, got " + type_of(json));
    return json.get<bool>();
}

std::string Reader::text(const std::string& key)
{
    const Json& json = member(key, "text");
    if (!json.is_string()) refuse(key, "expected text, got " + type_of(json));
    return json.get<std::string>();
}

std::string Reader::text_or(const std::string& key, const std::string& otherwise)
{
    node_->asked.insert(key);
    return has(key) ? text(key) : otherwise;
}

std::string Reader::choice(const std::string& key, const std::vector<std::string>& choices)
{
    const std::string word = text(key);
    std::string list;
    for (const std::string& candidate : choices) {
        if (word == candidate) return word;
        list += (list.empty() ? "" : ", ") + candidate;
    }
    const std::string guess = nearest_word(word, choices);
    refuse(key, "\"" + shortened(word) + "\" is none of " + list +
                    (guess.empty() ? "" : "; did you mean \"" + guess + "\"?"));
}

std::string Reader::choice_or(const std::string& key, const std::string& otherwise,
                              const std::vector<std::string>& choices)
{
    node_->asked.insert(key);
    return has(key) ? choice(key, choices) : otherwise;
}

Eigen::VectorXd Reader::vector(const std::string& key, int size)
{
    const Json& json = member(key, "an array of numbers");
    if (!json.is_array()) refuse(key, "expected an array of numbers, got " + type_of(json));
    if (size >= 0 && json.size() != static_cast<std::size_t>(size))
        refuse(key, "expected " + std::to_string(size) + " numbers, got " + std::to_string(json.size()));
    Eigen::VectorXd values(static_cast<Eigen::Index>(json.size()));
    const auto read = size < 0 ? any_number : number_of; // a list of any length is what a program wrote
    for (std::size_t i = 0; i < json.size(); ++i)
        values[static_cast<Eigen::Index>(i)] = read(*this, json[i], key + "[" + std::to_string(i) + "]");
    return values;
}

Eigen::MatrixXd Reader::matrix(const std::string& key, int columns)
{
    const Eigen::MatrixXd values =
        ragged(key, std::max(columns, 0), columns < 0 ? std::numeric_limits<int>::max() : columns);
    if (values.hasNaN()) refuse(key, "rows of different length");
    return values;
}

Eigen::MatrixXd Reader::ragged(const std::string& key, int least_columns, int most_columns)
{
    const Json& json = member(key, "an array of rows");
    if (!json.is_array()) refuse(key, "expected an array of rows, got " + type_of(json));
    auto columns = static_cast<std::size_t>(least_columns);
    for (const Json& row : json)
        if (row.is_array()) columns = std::max(columns, row.size());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Eigen::MatrixXd values =
        Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(json.size()), static_cast<Eigen::Index>(columns), nan);
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string place = key + "[" + std::to_string(i) + "]";
        if (!json[i].is_array()) refuse(place, "expected an array of numbers, got " + type_of(json[i]));
        const std::size_t size = json[i].size();
        if (size < static_cast<std::size_t>(least_columns) || size > static_cast<std::size_t>(most_columns))
            refuse(place, "expected " + std::to_string(least_columns) +
                              (least_columns == most_columns ? "" : " to " + std::to_string(most_columns)) +
                              " numbers, got " + std::to_string(size));
        for (std::size_t j = 0; j < size; ++j) {
            values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                number_of(*this, json[i][j], place + "[" + std::to_string(j) + "]");
        }
    }
    return values;
}

std::vector<std::vector<std::string>> Reader::text_rows(const std::string& key, int size)
{
    const Json& json = member(key, "an array of rows");
    if (!json.is_array()) refuse(key, "expected an array of rows, got " + type_of(json));
    std::vector<std::vector<std::string>> rows(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string place = key + "[" + std::to_string(i) + "]";
        if (!json[i].is_array() || json[i].size() != static_cast<std::size_t>(size))
            refuse(place, "expected " + std::to_string(size) + " texts");
        for (std::size_t j = 0; j < json[i].size(); ++j) {
            if (!json[i][j].is_string())
                refuse(place + "[" + std::to_string(j) + "]", "expected text, got " + type_of(json[i][j]));
            rows[i].push_back(json[i][j].get<std::string>());
        }
    }
    return rows;
}

std::vector<Eigen::MatrixXd> Reader::grid(const std::string& key, int size)
{
    const Json& json = member(key, "an array of rows");
    if (!json.is_array() || json.empty()) refuse(key, "expected an array of rows, got " + type_of(json));
    const std::size_t columns = json[0].size();
    std::vector<Eigen::MatrixXd> layers(
        static_cast<std::size_t>(size),
        Eigen::MatrixXd(static_cast<Eigen::Index>(json.size()), static_cast<Eigen::Index>(columns)));
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string row = key + "[" + std::to_string(i) + "]";
        if (!json[i].is_array()) refuse(row, "expected an array, got " + type_of(json[i]));
        if (json[i].size() != columns) refuse(key, "rows of different length");
        for (std::size_t j = 0; j < columns; ++j) {
            const Json& point = json[i][j];
            const std::string place = row + "[" + std::to_string(j) + "]";
            if (!point.is_array() || point.size() != static_cast<std::size_t>(size))
                refuse(place, "expected " + std::to_string(size) + " numbers");
            for (std::size_t k = 0; k < layers.size(); ++k)
                layers[k](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    number_of(*this, point[k], place + "[" + std::to_string(k) + "]");
        }
    }
    return layers;
}

bool Reader::is_null(const std::string& key)
{
    node_->asked.insert(key);
    const auto found = node_->json->find(key);
    return found == node_->json->end() || found->is_null();
}

Reader Reader::object(const std::string& key)
{
    const Json& json = member(key, "an object");
    if (!json.is_object()) refuse(key, "expected an object, got " + type_of(json));
    return {std::make_shared<Node>(Node{node_->document, &json, {}}), source_, path_of(key)};
}

std::optional<Reader> Reader::object_or_none(const std::string& key)
{
    node_->asked.insert(key);
    if (!has(key)) return std::nullopt;
    return object(key);
}

std::vector<Reader> Reader::objects(const std::string& key)
{
    const Json& json = member(key, "an array of objects");
    if (!json.is_array()) refuse(key, "expected an array of objects, got " + type_of(json));
    std::vector<Reader> readers;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string place = key + "[" + std::to_string(i) + "]";
        if (!json[i].is_object()) refuse(place, "expected an object, got " + type_of(json[i]));
        readers.push_back({std::make_shared<Node>(Node{node_->document, &json[i], {}}), source_, path_of(place)});
    }
    return readers;
}

void Reader::done() const
{
    const std::vector<std::string> known(node_->asked.begin(), node_->asked.end());
    for (const auto& item : node_->json->items())
        if (!node_->asked.contains(item.key())) {
            const std::string guess = nearest_word(item.key(), known);
            refuse(item.key(), "unknown key" + (guess.empty() ? std::string() : ", did you mean \"" + guess + "\"?"));
        }
}

} // namespace fettle::json
