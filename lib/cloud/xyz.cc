#include "cloud/xyz.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cctype>

namespace fettle::cloud {

namespace {

constexpr std::size_t kMaxColumns = 1000; // scanners write a dozen, and names are compared in quadratic time

/// The words of a line: between commas, or between semicolons, if it has any, else between blanks and tabs. Numbers
/// with decimal commas are then refused: between two of them is a blank.
std::vector<std::string_view> fields_of(std::string_view line)
{
    const char separator = line.find(';') != std::string_view::npos ? ';' : ',';
    if (line.find(separator) == std::string_view::npos) return core::words(line);
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t end = std::min(line.find(separator), line.size());
        const std::vector<std::string_view> words = core::words(line.substr(0, end));
        fields.push_back(words.size() == 1 ? words[0] : line.substr(0, end));
        if (end == line.size()) return fields;
        line.remove_prefix(end + 1);
    }
}

/// Names in a header line such as "x y z intensity"; empty for another line.
std::vector<std::string> column_names(std::string_view line)
{
    if (line.starts_with("//")) line.remove_prefix(2);
    std::vector<std::string> names;
    for (const std::string_view word : fields_of(line)) names.emplace_back(word);
    if (names.size() < 3) return {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char letter = "xyz"[axis];
        if (names[axis].size() != 1 || std::tolower(static_cast<unsigned char>(names[axis][0])) != letter) return {};
        names[axis] = letter;
    }
    return names;
}

/// @param columns  expected number of values; 0: at least 3
std::vector<double> parse_row(const core::FileLines& lines, std::size_t columns)
{
    std::vector<double> row;
    for (const std::string_view word : fields_of(lines.line())) {
        const std::optional<double> value = core::parse_number(word);
        if (!value) lines.refuse(core::in_quotes(word) + " is not a number");
        row.push_back(*value);
    }
    if (columns == 0 && row.size() < 3) lines.refuse("expected at least 3 numbers, got " + std::to_string(row.size()));
    if (columns != 0 && row.size() != columns)
        lines.refuse("expected " + std::to_string(columns) + " numbers, got " + std::to_string(row.size()));
    return row;
}

} // namespace

Cloud parse_xyz(std::string_view bytes, const std::string& source)
{
    std::vector<std::string> names;
    std::vector<double> values; // row by row
    std::size_t columns = 0;
    core::FileLines lines(bytes, source);
    while (lines.next()) {
        if (core::is_blank_or_comment(lines.line())) continue;
        if (columns == 0) {
            names = column_names(lines.line());
            columns = names.size();
            if (columns != 0) continue;
        }
        const std::vector<double> row = parse_row(lines, columns);
        columns = row.size();
        values.insert(values.end(), row.begin(), row.end());
    }
    if (columns > kMaxColumns)
        throw core::InputError(source, std::to_string(columns) + " columns, at most " + std::to_string(kMaxColumns));
    for (std::size_t c = names.size(); c < columns; ++c)
        names.push_back(c < 3 ? std::string(1, "xyz"[c]) : "column" + std::to_string(c + 1));
    const std::size_t rows = columns == 0 ? 0 : values.size() / columns;
    const Eigen::Map<const Eigen::MatrixXd> table(values.data(), columns, rows);
    Cloud cloud;
    cloud.xyz = rows == 0 ? Eigen::Matrix3Xd(3, 0) : Eigen::Matrix3Xd(table.topRows(3));
    for (std::size_t c = 3; c < columns; ++c) {
        if (std::find(names.begin(), names.begin() + c, names[c]) != names.begin() + c)
            throw core::InputError(source, "column " + core::in_quotes(names[c]) + " is duplicated");
        set_field(cloud, names[c], rows == 0 ? Eigen::VectorXd(0) : Eigen::VectorXd(table.row(c)), sizeof(double));
    }
    return cloud;
}

bool looks_like_xyz(std::string_view bytes)
{
    core::Lines lines(bytes);
    while (lines.next()) {
        const std::string_view line = lines.line();
        if (core::is_blank_or_comment(line)) continue;
        return core::parse_number(fields_of(line).front()).has_value() || !column_names(line).empty();
    }
    return false;
}

} // namespace fettle::cloud
