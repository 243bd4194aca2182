#include "job/picked.h"

#include "core/content.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <cmath>
#include <vector>

namespace fettle::job {
namespace {

constexpr std::string_view kPclViewerPrefix = "Point index picked:";

/// The last three of three to five comma-separated fields; a label and an index may come first. Empty if malformed.
std::vector<double> parse_coordinates(std::string_view list)
{
    std::vector<std::string_view> parts;
    for (std::size_t end = 0; end != std::string_view::npos; list.remove_prefix(std::min(end + 1, list.size()))) {
        end = list.find(',');
        parts.push_back(list.substr(0, end));
    }
    std::vector<double> numbers;
    if (parts.size() < 3 || parts.size() > 5) return numbers;
    for (std::size_t n = parts.size() - 3; n < parts.size(); ++n) {
        std::string_view rest = parts[n];
        const auto number = core::parse_number(core::next_word(rest));
        if (!number || !std::isfinite(*number) || !core::next_word(rest).empty()) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

} // namespace

Eigen::Matrix3Xd read_picked_points(const std::string& path)
{
    return parse_picked_points(core::read_file(path), core::display_name(path));
}

Eigen::Matrix3Xd parse_picked_points(std::string_view bytes, const std::string& source)
{
    core::refuse_other_content(bytes, source, "picked points");
    const std::string_view text = core::strip_byte_order_mark(bytes, source);
    const bool viewer = text.find(kPclViewerPrefix) != std::string_view::npos;
    std::vector<double> numbers;
    core::Lines lines(text);
    while (lines.next()) {
        std::string_view line = lines.line();
        if (viewer) {
            const std::size_t at = line.find(kPclViewerPrefix), from = line.find('['), to = line.find(']');
            if (at == std::string_view::npos) continue;
            line = from < to && to != std::string_view::npos ? line.substr(from + 1, to - from - 1) : "";
        } else if (core::words(line).empty()) {
            continue;
        }
        const std::vector<double> point = parse_coordinates(line);
        if (point.empty())
            throw core::InputError(source, lines.location() + ": " + core::in_quotes(lines.line()) +
                                               " is not a point as pcd_viewer or CloudCompare writes it");
        numbers.insert(numbers.end(), point.begin(), point.end());
    }
    if (numbers.empty()) throw core::InputError(source, "no points were picked");
    return Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3, Eigen::Index(numbers.size() / 3));
}

} // namespace fettle::job
