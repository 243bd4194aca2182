#pragma once

#include "core/range.h"

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace fettle {

/// Declares an option (or a word without dashes) whose value `parse` reads; what it throws is said with the option's
/// name before it: "--tolerance: must be positive, got -1".
/// @param parse  throws InputError for a value that it refuses
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::function<void(const std::string&)>& parse);

/// @throws InputError if `text` is no number, or one out of range
double number_in(const std::string& text, const Range& range);

/// @throws InputError if `text` is no whole number from `least` to `most`
double whole_number_in(const std::string& text, double least, double most);

/// @throws InputError, with a guess at what was meant, if `text` is none of the choices
const std::string& one_of(const std::vector<std::string>& choices, const std::string& text);

/// "a,b" as "a" and "b"; nothing of an empty text.
std::vector<std::string> listed(const std::string& text);

/// "plane|swept|freeform"
std::string joined(const std::vector<std::string>& words, const std::string& separator);

} // namespace fettle
