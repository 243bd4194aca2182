#include "core/text.h"

#include "core/constants.h"
#include "core/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace fettle::core {
namespace {

template <typename Real>
std::string shortest(Real value)
{
    if (std::isnan(value)) return "nan"; // to_chars writes "-nan" for some
    char buffer[32];
    const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof buffer, value);
    return {buffer, result.ptr};
}

std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row[b.size()];
}

} // namespace

std::string to_text(double value) { return shortest(value); }

std::string to_text(float value) { return shortest(value); }

std::string to_short_text(double value)
{
    char buffer[32];
    const auto written = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6);
    return {buffer, written.ptr};
}

std::optional<double> parse_number(std::string_view text)
{
    if (text.starts_with('+')) { // from_chars does not accept a plus
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    double value = 0;
    const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

Eigen::VectorXd parse_number_list(std::string_view list)
{
    std::vector<double> numbers;
    for (std::size_t comma = 0; !list.empty(); list.remove_prefix(std::min(comma + 1, list.size()))) {
        comma = std::min(list.find(','), list.size());
        numbers.push_back(parse_number(list.substr(0, comma)).value_or(kNaN));
    }
    return Eigen::VectorXd::Map(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

Eigen::VectorXd parse_number_list(std::string_view list, const std::vector<std::string>& names)
{
    Eigen::VectorXd numbers(names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::size_t comma = std::min(list.find(','), list.size());
        const bool last = k + 1 == names.size();
        const auto number = parse_number(list.substr(0, comma));
        if (!number || !std::isfinite(*number) || last != (comma == list.size()))
            throw InputError("expected a number for " + names[k] + (last ? " at the end" : " and a comma") + ", got '" +
                             std::string(list) + "'");
        numbers[k] = *number;
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return numbers;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates)
{
    std::string best;
    std::size_t best_distance = 1 + word.size() / 3; // up to a third of the letters may be wrong
    for (const std::string& candidate : candidates)
        if (const std::size_t distance = edit_distance(word, candidate); distance <= best_distance) {
            if (distance == best_distance && !best.empty()) continue;
            best = candidate;
            best_distance = distance;
        }
    return best;
}

std::string join(const std::vector<std::string>& words, const std::string& separator)
{
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

} // namespace fettle::core
