#include "json/document.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <ostream>

namespace fettle::json {

using Json = nlohmann::ordered_json;

namespace {

// Largest object that is written on one line, such as {"length": "mm", "force": "N"}; others take a line per member.
constexpr std::size_t kMaxMembersPerLine = 6;

Json number_to_json(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

bool is_flat(const Json& json)
{
    for (const Json& element : json)
        if (element.is_structured()) return false;
    return true;
}

void dump(const Json& json, const std::string& indent, std::string& text)
{
    if (!json.is_structured() || json.empty()) {
        text += json.dump(-1, ' ', false, Json::error_handler_t::replace);
        return;
    }
    const bool object = json.is_object();
    const bool small = !object || (!indent.empty() && json.size() <= kMaxMembersPerLine);
    const bool one_line = small && is_flat(json);
    const std::string inner = indent + "  ";
    text += object ? '{' : '[';
    bool first = true;
    for (auto member = json.begin(); member != json.end(); ++member) {
        if (!first) text += one_line ? ", " : ",";
        if (!one_line) text += '\n' + inner;
        if (object) text += Json(member.key()).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
        dump(*member, inner, text);
        first = false;
    }
    if (!one_line) text += '\n' + indent;
    text += object ? '}' : ']';
}

} // namespace

Value::Value() : json_(std::make_unique<Json>(Json::object())) {}
Value::Value(double number) : json_(std::make_unique<Json>(number_to_json(number))) {}
Value::Value(int number) : json_(std::make_unique<Json>(number)) {}
Value::Value(Eigen::Index number) : json_(std::make_unique<Json>(number)) {}
Value::Value(std::size_t number) : json_(std::make_unique<Json>(number)) {}
Value::Value(bool flag) : json_(std::make_unique<Json>(flag)) {}
Value::Value(const char* text) : json_(std::make_unique<Json>(text)) {}
Value::Value(const std::string& text) : json_(std::make_unique<Json>(text)) {}

Value::Value(const Eigen::VectorXd& numbers) : json_(std::make_unique<Json>(Json::array()))
{
    for (const double number : numbers) json_->push_back(number_to_json(number));
}

Value::Value(const Eigen::MatrixXd& rows) : json_(std::make_unique<Json>(Json::array()))
{
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        Json row = Json::array();
        for (Eigen::Index j = 0; j < rows.cols(); ++j) row.push_back(number_to_json(rows(i, j)));
        json_->push_back(std::move(row));
    }
}

Value::Value(const std::vector<Value>& elements) : json_(std::make_unique<Json>(Json::array()))
{
    for (const Value& element : elements) json_->push_back(*element.json_);
}

Value::Value(const Value& other) : json_(std::make_unique<Json>(*other.json_)) {}
Value::Value(Value&&) noexcept = default;
Value::~Value() = default;

Value& Value::operator=(Value other)
{
    json_.swap(other.json_);
    return *this;
}

Value& Value::set(const std::string& key, const Value& value)
{
    (*json_)[key] = *value.json_;
    return *this;
}

std::string Value::text() const
{
    std::string text;
    dump(*json_, "", text);
    return text;
}

std::ostream& operator<<(std::ostream& out, const Value& value) { return out << value.text() << '\n'; }

} // namespace fettle::json
