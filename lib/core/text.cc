#include "core/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace fettle {
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
    if (text.starts_with('+')) { // from_chars knows no plus
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    double value = 0;
    const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates)
{
    std::string best;
    std::size_t best_distance = 1 + word.size() / 3; // a third of the letters wrong is still a slip
    for (const std::string& candidate : candidates)
        if (const std::size_t distance = edit_distance(word, candidate); distance <= best_distance) {
            if (distance == best_distance && !best.empty()) continue;
            best = candidate;
            best_distance = distance;
        }
    return best;
}

} // namespace fettle
