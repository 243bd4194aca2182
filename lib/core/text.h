#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// Shortest decimal text that reads back as the same number ("0.1", "1e-09", "nan"), whatever the locale.
std::string to_text(double value);
std::string to_text(float value);
/// Six digits, for the places and values in messages ("1.5" where a change of units made 1.4999999999999998).
std::string to_short_text(double value);

/// A decimal number and nothing else around it; "nan", "inf", "-inf" are numbers. Independent of the locale.
/// Out of range of double (1e400) or malformed (1,5): nothing.
std::optional<double> parse_number(std::string_view text);

/// The candidate that `word` was probably meant to be, for "did you mean"; empty if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

} // namespace fettle
