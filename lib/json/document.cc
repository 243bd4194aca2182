#include "json/document.h"

#include "core/constants.h"
#include "core/file.h"
#include "core/text.h"
#include "core/wrong_kind.h"
#include "json/parse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace fettle::json {

using Json = nlohmann::ordered_json;

struct Reader::Node {
    std::shared_ptr<const Json> document; ///< keeps the whole tree alive
    const Json* json;
    std::set<std::string> queried; ///< keys
};

Reader::Reader(std::shared_ptr<Node> node, std::string source, std::string path)
    : node_(std::move(node)), source_(std::move(source)), path_(std::move(path))
{
}

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

/// Shortens text so that a message stays one readable line.
std::string shortened(const std::string& text)
{
    constexpr std::size_t kMaxLength = 100;
    std::string line = text.substr(0, kMaxLength);
    if (text.size() > kMaxLength) line += "...";
    for (char& c : line)
        if ((c >= '\0' && c < ' ') || c == '\x7f') c = '?';
    return line;
}

std::string element_key(const std::string& key, std::size_t index) { return key + "[" + std::to_string(index) + "]"; }

double any_number(const Reader& reader, const Json& json, const std::string& key)
{
    if (!json.is_number()) reader.refuse(key, "expected a number, got " + type_of(json));
    return json.get<double>();
}

double number_of(const Reader& reader, const Json& json, const std::string& key)
{
    constexpr double kMaxMagnitude = 1e100; // larger squares, or numbers in other units, might overflow
    const double value = any_number(reader, json, key);
    if (std::abs(value) > kMaxMagnitude) reader.refuse(key, "no number may be as large as " + core::to_text(value));
    return value;
}

} // namespace

Reader Reader::open(const std::string& path)
{
    return parse(core::read_file(path, core::kMaxJsonBytes), core::display_name(path));
}

Reader Reader::parse(std::string_view text, const std::string& source)
{
    const auto document = std::make_shared<const Json>(parse_strictly(text, source));
    if (!document->is_object()) throw core::InputError(source, "expected a JSON object, got " + type_of(*document));
    return {std::make_shared<Node>(Node{document, document.get(), {}}), source, ""};
}

std::string Reader::path_of(const std::string& key) const
{
    return path_.empty() ? key : key.empty() ? path_ : path_ + "." + key;
}

void Reader::refuse(const std::string& key, const std::string& problem) const
{
    const std::string path = shortened(path_of(key));
    throw core::InputError(source_, path.empty() ? problem : path + ": " + problem);
}

bool Reader::has(const std::string& key) const { return node_->json->contains(key); }

bool Reader::query(const std::string& key)
{
    node_->queried.insert(key);
    return has(key);
}

const Json& Reader::member(const std::string& key, const char* expected)
{
    if (!query(key)) refuse(key, std::string("missing, expected ") + expected);
    return *node_->json->find(key);
}

const Json& Reader::array(const std::string& key, const char* expected)
{
    const Json& json = member(key, expected);
    if (!json.is_array()) refuse(key, std::string("expected ") + expected + ", got " + type_of(json));
    return json;
}

void Reader::expect_kind(const std::string& kind)
{
    const std::string got = text("kind");
    if (got != kind)
        throw core::WrongFileType(source_,
                                  path_of("kind") + ": expected \"" + kind + "\", got \"" + shortened(got) + "\"");
}

double Reader::number(const std::string& key, const core::Range& range)
{
    const double value = number_of(*this, member(key, "a number"), key);
    if (!range.contains(value)) refuse(key, "must be " + range.text() + ", got " + core::to_text(value));
    return value;
}

double Reader::number_or(const std::string& key, double fallback, const core::Range& range)
{
    return query(key) ? number(key, range) : fallback;
}

int Reader::integer(const std::string& key, int min, int max)
{
    const double value = number(key, core::Range::between(min, max));
    if (value != std::floor(value)) refuse(key, "must be a whole number, got " + core::to_text(value));
    return static_cast<int>(value);
}

bool Reader::flag_or(const std::string& key, bool fallback)
{
    if (!query(key)) return fallback;
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

std::string Reader::text_or(const std::string& key, const std::string& fallback)
{
    return query(key) ? text(key) : fallback;
}

std::string Reader::choice(const std::string& key, const std::vector<std::string>& choices)
{
    const std::string word = text(key);
    if (std::ranges::find(choices, word) != choices.end()) return word;
    const std::string guess = core::nearest_word(word, choices);
    refuse(key, "\"" + shortened(word) + "\" is none of " + core::join(choices, ", ") +
                    (guess.empty() ? "" : "; did you mean \"" + guess + "\"?"));
}

std::string Reader::choice_or(const std::string& key, const std::string& fallback,
                              const std::vector<std::string>& choices)
{
    return query(key) ? choice(key, choices) : fallback;
}

Eigen::VectorXd Reader::vector(const std::string& key, int size)
{
    const Json& json = array(key, "an array of numbers");
    if (size >= 0 && json.size() != static_cast<std::size_t>(size))
        refuse(key, "expected " + std::to_string(size) + " numbers, got " + std::to_string(json.size()));
    Eigen::VectorXd values(json.size());
    const auto read = size < 0 ? any_number : number_of; // a list of any length was written by a program
    for (std::size_t i = 0; i < json.size(); ++i) values[i] = read(*this, json[i], element_key(key, i));
    return values;
}

Eigen::MatrixXd Reader::matrix(const std::string& key, int columns)
{
    const Eigen::MatrixXd values =
        ragged_matrix(key, std::max(columns, 0), columns < 0 ? std::numeric_limits<int>::max() : columns);
    if (values.hasNaN()) refuse(key, "rows of different length");
    return values;
}

Eigen::MatrixXd Reader::ragged_matrix(const std::string& key, int min_columns, int max_columns)
{
    const Json& json = array(key, "an array of rows");
    std::size_t columns = min_columns;
    for (const Json& row : json)
        if (row.is_array()) columns = std::max(columns, row.size());
    Eigen::MatrixXd values = Eigen::MatrixXd::Constant(json.size(), columns, core::kNaN);
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string row = element_key(key, i);
        if (!json[i].is_array()) refuse(row, "expected an array of numbers, got " + type_of(json[i]));
        const std::size_t size = json[i].size();
        if (size < static_cast<std::size_t>(min_columns) || size > static_cast<std::size_t>(max_columns))
            refuse(row, "expected " + std::to_string(min_columns) +
                            (min_columns == max_columns ? "" : " to " + std::to_string(max_columns)) +
                            " numbers, got " + std::to_string(size));
        for (std::size_t j = 0; j < size; ++j) values(i, j) = number_of(*this, json[i][j], element_key(row, j));
    }
    return values;
}

std::vector<std::vector<std::string>> Reader::text_rows(const std::string& key, int size)
{
    const Json& json = array(key, "an array of rows");
    std::vector<std::vector<std::string>> rows(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string row = element_key(key, i);
        if (!json[i].is_array() || json[i].size() != static_cast<std::size_t>(size))
            refuse(row, "expected " + std::to_string(size) + " texts");
        for (std::size_t j = 0; j < json[i].size(); ++j) {
            if (!json[i][j].is_string()) refuse(element_key(row, j), "expected text, got " + type_of(json[i][j]));
            rows[i].push_back(json[i][j].get<std::string>());
        }
    }
    return rows;
}

std::vector<Eigen::MatrixXd> Reader::grid(const std::string& key, int size)
{
    const Json& json = array(key, "an array of rows");
    if (json.empty()) refuse(key, "expected an array of rows, got " + type_of(json));
    const std::size_t columns = json[0].size();
    std::vector<Eigen::MatrixXd> layers(size, Eigen::MatrixXd(json.size(), columns));
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string row = element_key(key, i);
        if (!json[i].is_array()) refuse(row, "expected an array, got " + type_of(json[i]));
        if (json[i].size() != columns) refuse(key, "rows of different length");
        for (std::size_t j = 0; j < columns; ++j) {
            const Json& point = json[i][j];
            const std::string element = element_key(row, j);
            if (!point.is_array() || point.size() != layers.size())
                refuse(element, "expected " + std::to_string(size) + " numbers");
            for (std::size_t k = 0; k < layers.size(); ++k)
                layers[k](i, j) = number_of(*this, point[k], element_key(element, k));
        }
    }
    return layers;
}

bool Reader::is_null_or_missing(const std::string& key) { return !query(key) || node_->json->find(key)->is_null(); }

Reader Reader::object(const std::string& key)
{
    const Json& json = member(key, "an object");
    if (!json.is_object()) refuse(key, "expected an object, got " + type_of(json));
    return {std::make_shared<Node>(Node{node_->document, &json, {}}), source_, path_of(key)};
}

std::optional<Reader> Reader::optional_object(const std::string& key)
{
    if (!query(key)) return std::nullopt;
    return object(key);
}

std::vector<Reader> Reader::objects(const std::string& key)
{
    const Json& json = array(key, "an array of objects");
    std::vector<Reader> readers;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string element = element_key(key, i);
        if (!json[i].is_object()) refuse(element, "expected an object, got " + type_of(json[i]));
        readers.push_back({std::make_shared<Node>(Node{node_->document, &json[i], {}}), source_, path_of(element)});
    }
    return readers;
}

void Reader::reject_unknown_keys() const
{
    const std::vector<std::string> known(node_->queried.begin(), node_->queried.end());
    for (const auto& item : node_->json->items())
        if (!node_->queried.contains(item.key())) {
            const std::string guess = core::nearest_word(item.key(), known);
            refuse(item.key(), "unknown key" + (guess.empty() ? std::string() : ", did you mean \"" + guess + "\"?"));
        }
}

} // namespace fettle::json
