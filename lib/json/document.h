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

/// JSON behind types of our own: strict reading with key paths in all messages, and writing. Only json/*.cc compiles
/// nlohmann::json.
namespace fettle::json {

/// A JSON value for writing. Members keep their order. NaN and infinities are written as null.
class Value {
  public:
    Value(); ///< an empty object
    Value(double number);
    Value(int number);
    Value(Eigen::Index number);
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
    /// Indented text with arrays of numbers on one line. Numbers read back as the same double.
    std::string text() const;

  private:
    friend class Reader;
    std::unique_ptr<nlohmann::ordered_json> json_;
};

/// Writes `text()` and a newline.
std::ostream& operator<<(std::ostream& out, const Value& value);

/// Reads an object of a JSON file. done() rejects members that were never queried, so that a misspelt key is an error.
/// All functions throw InputError "FILE: path.to.key: what is wrong".
class Reader {
  public:
    /// @param path  a file, or "-" for stdin
    static Reader open(const std::string& path);
    /// @param source  name for messages
    static Reader parse(std::string_view text, const std::string& source);

    /// Checks the member "kind", which names the type of document. @throws WrongFileType
    void expect_kind(const std::string& kind);
    bool has(const std::string& key) const;

    double number(const std::string& key, const core::Range& range = {});
    double number_or(const std::string& key, double fallback, const core::Range& range = {});
    int integer(const std::string& key, int min, int max);
    bool flag_or(const std::string& key, bool fallback);
    std::string text(const std::string& key);
    std::string text_or(const std::string& key, const std::string& fallback);
    /// One of the words in `choices`.
    std::string choice(const std::string& key, const std::vector<std::string>& choices);
    std::string choice_or(const std::string& key, const std::string& fallback, const std::vector<std::string>& choices);

    /// An array of finite numbers. @param size  required length; -1: any
    Eigen::VectorXd vector(const std::string& key, int size = -1);
    /// An array of rows, which are equally long arrays of finite numbers. @param columns  required length; -1: any
    Eigen::MatrixXd matrix(const std::string& key, int columns = -1);
    /// A matrix whose rows may differ in length, between the two limits; missing elements are NaN.
    Eigen::MatrixXd ragged_matrix(const std::string& key, int min_columns, int max_columns);

    /// An array of equally long rows of equally long arrays of finite numbers: [k](i, j) is number k of element j of
    /// row i. @param size  numbers in an element
    std::vector<Eigen::MatrixXd> grid(const std::string& key, int size);
    /// An array of rows of `size` strings each.
    std::vector<std::vector<std::string>> text_rows(const std::string& key, int size);
    /// True if the member is missing or null.
    bool is_null_or_missing(const std::string& key);

    Reader object(const std::string& key);
    std::optional<Reader> optional_object(const std::string& key);
    /// An array of objects.
    std::vector<Reader> objects(const std::string& key);

    /// @throws InputError for a member that was not queried
    void reject_unknown_keys() const;
    /// Throws InputError "FILE: path.to.key: problem", for checks by the caller; an empty key means the object itself.
    [[noreturn]] void refuse(const std::string& key, const std::string& problem) const;
    const std::string& source() const { return source_; }

  private:
    struct Node;
    Reader(std::shared_ptr<Node> node, std::string source, std::string path);
    /// Marks a key as queried. @return  true if the object has it
    bool query(const std::string& key);
    /// @param expected  "a number", for messages
    const nlohmann::ordered_json& member(const std::string& key, const char* expected);
    const nlohmann::ordered_json& array(const std::string& key, const char* expected);
    std::string path_of(const std::string& key) const;

    std::shared_ptr<Node> node_;
    std::string source_;
    std::string path_;
};

} // namespace fettle::json
