#include "job/picked.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <cmath>
#include <vector>

namespace fettle {
namespace {

constexpr std::string_view kViewer = "Point index picked:";

/// The last three of some that commas separate; before them one or two: a label, an index.
std::vector<double> last_three(std::string_view list)
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
        const auto number = parse_number(next_word(rest));
        if (!number || !std::isfinite(*number) || !next_word(rest).empty()) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

} // namespace

Eigen::Matrix3Xd read_picked(const std::string& path) { return parse_picked(read_whole(path), display_name(path)); }

Eigen::Matrix3Xd parse_picked(std::string_view bytes, const std::string& source)
{
    const std::string_view text = without_mark(bytes, source);
    const bool viewer = text.find(kViewer) != std::string_view::npos;
    std::vector<double> numbers;
    Lines lines(text);
    while (lines.next()) {
        std::string_view line = lines.line();
        if (viewer) {
            const std::size_t at = line.find(kViewer), from = line.find('['), to = line.find(']');
            if (at == std::string_view::npos) continue;
            line = from < to && to != std::string_view::npos ? line.substr(from + 1, to - from - 1) : "";
        } else if (words(line).empty()) {
            continue;
        }
        const std::vector<double> point = last_three(line);
        if (point.empty())
            throw InputError(source, lines.place() + ": " + in_quotes(lines.line()) +
                                         " is no point of pcd_viewer's or CloudCompare's");
        numbers.insert(numbers.end(), point.begin(), point.end());
    }
    if (numbers.empty()) throw InputError(source, "no points were picked");
    return Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3, Eigen::Index(numbers.size() / 3));
}

} // namespace fettle
