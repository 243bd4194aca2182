#include "cloud/xyz.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cctype>

namespace fettle {

namespace {

constexpr std::size_t kMostColumns = 1000; // scanners write a dozen; the columns are told apart by name, all by all

bool is_skipped(std::string_view line)
{
    const std::size_t first = line.find_first_not_of(" \t");
    return first == std::string_view::npos || line[first] == '#';
}

// The names of a first line "x y z intensity"; none if it is something else.
std::vector<std::string> column_names(std::string_view line)
{
    if (line.starts_with("//")) line.remove_prefix(2);
    std::vector<std::string> names;
    for (const std::string_view word : words(line)) names.emplace_back(word);
    if (names.size() < 3) return {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char letter = "xyz"[axis];
        if (names[axis].size() != 1 || std::tolower(static_cast<unsigned char>(names[axis][0])) != letter) return {};
        names[axis] = letter;
    }
    return names;
}

std::vector<double> parse_row(std::string_view line, std::size_t columns, const std::string& place)
{
    std::vector<double> row;
    for (const std::string_view word : words(line)) {
        const std::optional<double> value = parse_number(word);
        if (!value) throw InputError(place + in_quotes(word) + " is no number");
        row.push_back(*value);
    }
    if (columns == 0 && row.size() < 3)
        throw InputError(place + "expected at least 3 numbers, got " + std::to_string(row.size()));
    if (columns != 0 && row.size() != columns)
        throw InputError(place + "expected " + std::to_string(columns) + " numbers, got " + std::to_string(row.size()));
    return row;
}

} // namespace

Cloud parse_xyz(std::string_view bytes, const std::string& source)
{
    std::vector<std::string> names;
    std::vector<double> values; // row after row
    std::size_t columns = 0;
    Lines lines(bytes);
    while (lines.next()) {
        if (is_skipped(lines.line())) continue;
        if (columns == 0) {
            names = column_names(lines.line());
            columns = names.size();
            if (columns != 0) continue;
        }
        const std::vector<double> row = parse_row(lines.line(), columns, source + ": " + lines.place() + ": ");
        columns = row.size();
        values.insert(values.end(), row.begin(), row.end());
    }
    if (columns > kMostColumns)
        throw InputError(source, std::to_string(columns) + " columns, at most " + std::to_string(kMostColumns));
    for (std::size_t c = names.size(); c < columns; ++c)
        names.push_back(c < 3 ? std::string(1, "xyz"[c]) : "column" + std::to_string(c + 1));
    const auto rows = static_cast<Eigen::Index>(columns == 0 ? 0 : values.size() / columns);
    const Eigen::Map<const Eigen::MatrixXd> table(values.data(), static_cast<Eigen::Index>(columns), rows);
    Cloud cloud;
    cloud.xyz = rows == 0 ? Eigen::Matrix3Xd(3, 0) : Eigen::Matrix3Xd(table.topRows(3));
    for (std::size_t c = 3; c < columns; ++c) {
        if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(c), names[c]) - names.begin() !=
            static_cast<std::ptrdiff_t>(c))
            throw InputError(source, "column " + in_quotes(names[c]) + " stands twice");
        set_field(cloud, names[c],
                  rows == 0 ? Eigen::VectorXd(0) : Eigen::VectorXd(table.row(static_cast<Eigen::Index>(c))),
                  sizeof(double));
    }
    return cloud;
}

bool looks_like_xyz(std::string_view bytes)
{
    Lines lines(bytes);
    while (lines.next()) {
        std::string_view line = lines.line();
        if (is_skipped(line)) continue;
        return parse_number(next_word(line)).has_value() || !column_names(lines.line()).empty();
    }
    return false;
}

} // namespace fettle
