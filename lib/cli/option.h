#pragma once

#include "core/range.h"

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace fettle::cli {

/// Declares an option, or a positional argument, whose value is read by `parse`. The messages of its exceptions get the
/// option's name: "--tolerance: must be positive, got -1".
/// @param parse  throws InputError for an invalid value
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::function<void(const std::string&)>& parse);

/// @throws InputError if `text` is not a number or is out of range
double parse_number_in(const std::string& text, const core::Range& range);

/// @throws InputError if `text` is not an integer from `min` to `max`
double parse_integer_in(const std::string& text, double min, double max);

/// @return  `text`   @throws InputError, with a suggestion, if it is none of the choices
const std::string& check_choice(const std::vector<std::string>& choices, const std::string& text);

/// Splits at commas: "a,b" into "a" and "b". An empty text has no parts.
std::vector<std::string> split_list(const std::string& text);

} // namespace fettle::cli
