#pragma once

#include "core/range.h"

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// JSON behind our own types: strict reading with key paths in every message, and plain writing.
namespace fettle::json {

/// A value under construction, for writing. Members keep their order. NaN and infinities are written as null.
class Value {
  public:
    Value(); ///< an empty object
    Value(double number);
    Value(int number);
    Value(std::size_t number);
    Value(bool flag);
    Value(const char* text);
    Value(const std::string& text);
    Value(const Eigen::VectorXd& numbers); ///< [1, 2, 3]
    Value(const Eigen::MatrixXd& rows);    ///< [[row], [row]]; points are columns, so pass points.transpose()
    Value(const std::vector<Value>& elements);
    Value(const Value&);
    Value(Value&&) noexcept;
    Value& operator=(Value);
    ~Value();

    /// Adds or replaces a member of an object.
    Value& set(const std::string& key, const Value& value);
    /// Indented text; arrays of numbers stay on one line. Numbers read back to the same double.
    std::string text() const;

  private:
    friend class Reader;
    std::unique_ptr<nlohmann::ordered_json> json_;
};

/// Writes `text()` and a newline.
std::ostream& operator<<(std::ostream& out, const Value& value);

/// One object of a JSON file that is being read. Every member must be asked for: `done()` refuses what nobody asked
/// for, so a misspelt key never passes silently. All functions throw InputError "FILE: path.to.key: what is wrong".
class Reader {
  public:
    /// @param path  a file, or "-" for stdin
    static Reader open(const std::string& path);
    /// @param source  the name for messages
    static Reader parse(std::string_view text, const std::string& source);

    /// The first member "kind"; refused if it is another one.
    void expect_kind(const std::string& kind);
    bool has(const std::string& key) const;

    double number(const std::string& key, const Range& range = {});
    double number_or(const std::string& key, double otherwise, const Range& range = {});
    int integer(const std::string& key, int least, int most);
    bool flag_or(const std::string& key, bool otherwise);
    std::string text(const std::string& key);
    std::string text_or(const std::string& key, const std::string& otherwise);
    /// A word out of `choices`; "did you mean" otherwise.
    std::string choice(const std::string& key, const std::vector<std::string>& choices);
    std::string choice_or(const std::string& key, const std::string& otherwise,
                          const std::vector<std::string>& choices);

    /// An array of finite numbers. @param size  the length it must have; -1: any
    Eigen::VectorXd vector(const std::string& key, int size = -1);
    /// An array of equally long arrays of finite numbers, one a row. @param columns  what they must have; -1: any
    Eigen::MatrixXd matrix(const std::string& key, int columns = -1);
    /// As matrix, but rows may have any length between the two; what is missing is NaN.
    Eigen::MatrixXd ragged(const std::string& key, int least_columns, int most_columns);

    /// An array of equally long rows of equally long arrays of finite numbers: [k](i, j) is number k of element j of
    /// row i. @param size  numbers in an element
    std::vector<Eigen::MatrixXd> grid(const std::string& key, int size);
    /// An array of rows of `size` texts each.
    std::vector<std::vector<std::string>> text_rows(const std::string& key, int size);
    /// Is the member missing, or null?
    bool is_null(const std::string& key);

    Reader object(const std::string& key);
    std::optional<Reader> object_or_none(const std::string& key);
    /// An array of objects.
    std::vector<Reader> objects(const std::string& key);

    /// Refuses members that were not asked for.
    void done() const;
    /// "FILE: path.to.key: problem", for checks that the caller makes; an empty key means the object itself.
    [[noreturn]] void refuse(const std::string& key, const std::string& problem) const;
    const std::string& source() const { return source_; }

  private:
    struct Node;
    Reader(std::shared_ptr<Node> node, std::string source, std::string path);
    const nlohmann::ordered_json& member(const std::string& key, const char* wanted);
    std::string path_of(const std::string& key) const;

    std::shared_ptr<Node> node_;
    std::string source_;
    std::string path_;
};

} // namespace fettle::json
