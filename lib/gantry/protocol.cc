#include "gantry/protocol.h"

#include "core/text.h"

#include <cmath>
#include <initializer_list>

namespace fettle::protocol {
namespace {

std::string join(std::initializer_list<double> numbers)
{
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : " ") + to_text(number);
    return text;
}

/// The rest of what is no answer, for messages.
constexpr std::size_t kShown = 60;

[[noreturn]] void refuse(std::string_view text)
{
    std::string shown;
    for (const char c : text.substr(0, kShown)) shown += c >= ' ' && c < 127 ? c : '?';
    throw GantryFault("makes no sense: '" + shown + "'");
}

std::vector<double> numbers_in(std::string_view text, std::size_t count)
{
    std::vector<double> numbers;
    for (std::string_view rest = text; !rest.empty();) {
        const auto number = parse_number(next_word(rest));
        if (!number) refuse(text);
        if (!std::isfinite(*number)) throw GantryFault("says " + to_text(*number) + ": '" + std::string(text) + "'");
        numbers.push_back(*number);
    }
    if (numbers.size() != count) refuse(text);
    return numbers;
}

} // namespace

std::string_view next_word(std::string_view& line)
{
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    return word;
}

std::string text_of(const Limits& l)
{
    return join({l.least.x(), l.most.x(), l.least.y(), l.most.y(), l.least.z(), l.most.z(), l.speed, l.force});
}

std::string text_of(const GantryStatus& s)
{
    return join({s.time, s.commanded.x(), s.commanded.y(), s.commanded.z(), s.deflection, s.force, s.peak_force});
}

Limits limits_in(std::string_view text)
{
    const std::vector<double> n = numbers_in(text, 8);
    return {{n[0], n[2], n[4]}, {n[1], n[3], n[5]}, n[6], n[7]};
}

GantryStatus status_in(std::string_view text)
{
    const std::vector<double> n = numbers_in(text, 7);
    return {n[0], {n[1], n[2], n[3]}, n[4], n[5], n[6]};
}

double number_in(std::string_view text) { return numbers_in(text, 1).front(); }

} // namespace fettle::protocol
