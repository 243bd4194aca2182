#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::core {

/// Shortest decimal text that reads back as the same number ("0.1", "1e-09", "nan"), independent of the locale.
std::string to_text(double value);
std::string to_text(float value);
/// Six significant digits, for values in messages ("1.5" where a unit conversion made 1.4999999999999998).
std::string to_short_text(double value);

/// Parses a decimal number, independent of the locale; "nan", "inf" and "-inf" are numbers. Returns nothing for other
/// text (1,5) and for numbers out of range (1e400).
std::optional<double> parse_number(std::string_view text);

/// Numbers separated by commas; NaN for a part that is not a number.
Eigen::VectorXd parse_number_list(std::string_view list);
/// Finite numbers separated by commas, as many as there are names ("12,3" for an option).
/// @param names  what the numbers mean, for messages   @throws InputError for anything else
Eigen::VectorXd parse_number_list(std::string_view list, const std::vector<std::string>& names);

/// Candidate closest to `word` in edit distance, for "did you mean"; empty if none is close.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// Joins words: "plane|swept|freeform".
std::string join(const std::vector<std::string>& words, const std::string& separator);

} // namespace fettle::core
