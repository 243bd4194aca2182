#include "cli/option.h"

#include "core/error.h"
#include "core/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace fettle {

// CLI11 repeats the option's names in its own way: it is given ours, without the short one.
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::function<void(const std::string&)>& parse)
{
    const std::size_t dashes = names.find("--");
    const std::string shown = names.substr(dashes == std::string::npos ? 0 : dashes);
    return app.add_option_function<std::string>(
        names,
        [shown, parse](const std::string& text) {
            try {
                parse(text);
            } catch (const InputError& error) {
                throw CLI::ValidationError(shown + ": " + error.what());
            }
        },
        help);
}

double number_in(const std::string& text, const Range& range)
{
    const std::optional<double> value = parse_number(text);
    if (!value) throw InputError("expected a number, got '" + text + "'");
    if (!range.contains(*value)) throw InputError("must be " + range.text() + ", got " + text);
    return *value;
}

double whole_number_in(const std::string& text, double least, double most)
{
    const double number = number_in(text, Range::between(least, most));
    if (number != std::floor(number)) throw InputError("must be whole, got " + text);
    return number;
}

const std::string& one_of(const std::vector<std::string>& choices, const std::string& text)
{
    if (std::find(choices.begin(), choices.end(), text) != choices.end()) return text;
    const std::string guess = nearest_word(text, choices);
    throw InputError("'" + text + "' is none of " + joined(choices, ", ") +
                     (guess.empty() ? "" : "; did you mean '" + guess + "'?"));
}

std::vector<std::string> listed(const std::string& text)
{
    std::vector<std::string> parts;
    if (text.empty()) return parts;
    std::istringstream rest(text + ","); // what follows the last comma is a part, too
    for (std::string part; std::getline(rest, part, ',');) parts.push_back(part);
    return parts;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator)
{
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

} // namespace fettle
