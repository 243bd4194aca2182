#include "job/picked.h"

#include "core/constants.h"
#include "core/content.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace fettle::job {
namespace {

constexpr std::string_view kPclViewerPrefix = "Point index picked:";

using Words = std::vector<std::string_view>;

/// The parts of a line between commas, between semicolons, or else between blanks.
Words split_line(std::string_view line, char& separator)
{
    separator = line.find(';') != std::string_view::npos ? ';' : line.find(',') != std::string_view::npos ? ',' : ' ';
    if (separator == ' ') return core::words(line);
    Words parts;
    for (std::size_t end = 0; end != std::string_view::npos; line.remove_prefix(std::min(end + 1, line.size()))) {
        end = line.find(separator);
        parts.push_back(line.substr(0, end));
    }
    while (separator == ';' && !parts.empty() && core::words(parts.back()).empty()) parts.pop_back();
    return parts;
}

std::optional<double> finite_number(std::string_view part)
{
    const auto number = core::parse_number(core::next_word(part));
    return number && std::isfinite(*number) && core::next_word(part).empty() ? number : std::nullopt;
}

/// Columns of x, y and z in a line that names them, "//X Y Z"; empty: none.
std::vector<std::size_t> named_columns(std::string_view header)
{
    if (!header.starts_with("//")) return {};
    char separator = ' ';
    const Words names = split_line(header.substr(2), separator);
    std::vector<std::size_t> columns;
    for (const std::string_view name : {"X", "Y", "Z"})
        for (std::size_t k = 0; k < names.size(); ++k)
            if (std::string_view rest = names[k]; core::next_word(rest) == name) columns.push_back(k);
    return columns;
}

/// Position and size of the coordinates among the parts of a line; nothing if it cannot be a point.
/// @param columns  that a header named; empty: none
std::vector<std::size_t> coordinate_columns(const Words& parts, char separator, const std::vector<std::size_t>& columns,
                                            bool may_be_flat)
{
    if (!columns.empty()) return columns;
    if (may_be_flat && parts.size() == 2) return {0, 1};
    constexpr std::size_t kMaxListed = 5; // label, index and three coordinates
    if (parts.size() < 3 || (separator == ',' && parts.size() > kMaxListed)) return {};
    if (separator != ',') return {0, 1, 2};
    const std::size_t n = parts.size();
    if (may_be_flat && n == 3 && !finite_number(parts[0])) return {1, 2}; // a label
    return {n - 3, n - 2, n - 1};
}

/// x, y and z of a line, z NaN if it may be missing and is. Empty if malformed.
std::vector<double> parse_coordinates(const Words& parts, char separator, const std::vector<std::size_t>& columns,
                                      bool may_be_flat)
{
    std::vector<double> numbers;
    for (const std::size_t k : coordinate_columns(parts, separator, columns, may_be_flat)) {
        const auto number = k < parts.size() ? finite_number(parts[k]) : std::nullopt;
        if (!number) return {};
        numbers.push_back(*number);
    }
    if (numbers.size() == 2 && may_be_flat) numbers.push_back(core::kNaN);
    if (numbers.size() != 3) numbers.clear();
    return numbers;
}

/// The boundary of a label such as B1 or S12; 0: none.
char boundary_of(std::string_view label)
{
    const std::string_view name = core::next_word(label);
    if (name.size() < 2 || (name[0] != 'B' && name[0] != 'S')) return 0;
    return name.find_first_not_of("0123456789", 1) == std::string_view::npos ? name[0] : char(0);
}

} // namespace

Eigen::Matrix3Xd read_picked_points(const std::string& path, const WantedPicks& wanted)
{
    return parse_picked_points(core::read_file(path), core::display_name(path), wanted);
}

Eigen::Matrix3Xd parse_picked_points(std::string_view bytes, const std::string& source, const WantedPicks& wanted)
{
    core::refuse_other_content(bytes, source, "picked points");
    const std::string_view text = core::strip_byte_order_mark(bytes, source);
    const bool viewer = text.find(kPclViewerPrefix) != std::string_view::npos;
    std::vector<double> numbers;
    std::vector<std::size_t> columns;
    bool is_first = true;
    core::Lines lines(text);
    while (lines.next()) {
        std::string_view line = lines.line();
        if (viewer) {
            const std::size_t at = line.find(kPclViewerPrefix), from = line.find('['), to = line.find(']');
            if (at == std::string_view::npos) continue;
            line = from < to && to != std::string_view::npos ? line.substr(from + 1, to - from - 1) : "";
        } else if (core::words(line).empty() || line.starts_with('#')) {
            continue;
        }
        if (std::exchange(is_first, false) && line.starts_with("//")) {
            columns = named_columns(line);
            if (columns.size() == 3 || (wanted.may_be_flat && columns.size() == 2)) continue;
        }
        char separator = ' ';
        const Words parts = split_line(line, separator);
        const std::vector<double> point = parse_coordinates(parts, separator, columns, wanted.may_be_flat);
        if (point.empty())
            throw core::InputError(source, lines.location() + ": " + core::in_quotes(lines.line()) +
                                               " is not a point as pcd_viewer or CloudCompare writes it");
        const char boundary = boundary_of(parts.front());
        if (wanted.boundary != 0 && boundary != 0 && boundary != wanted.boundary) continue;
        numbers.insert(numbers.end(), point.begin(), point.end());
    }
    if (numbers.empty()) throw core::InputError(source, "no points were picked");
    return Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3, Eigen::Index(numbers.size() / 3));
}

bool holds_both_boundaries(std::string_view bytes)
{
    bool has_B = false, has_S = false;
    core::Lines lines(bytes);
    while (lines.next()) {
        const char boundary = boundary_of(lines.line().substr(0, lines.line().find(',')));
        has_B = has_B || boundary == 'B';
        has_S = has_S || boundary == 'S';
    }
    return has_B && has_S;
}

} // namespace fettle::job
