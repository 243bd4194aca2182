#include "cli/option.h"

#include "core/error.h"
#include "core/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace fettle::cli {

// CLI11 would name the option in its own way; the message has its long name only.
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::function<void(const std::string&)>& parse)
{
    const std::size_t dashes = names.find("--");
    const std::string long_name = names.substr(dashes == std::string::npos ? 0 : dashes);
    return app.add_option_function<std::string>(
        names,
        [long_name, parse](const std::string& text) {
            try {
                parse(text);
            } catch (const core::InputError& error) {
                throw CLI::ValidationError(long_name + ": " + error.what());
            }
        },
        help);
}

double parse_number_in(const std::string& text, const core::Range& range)
{
    const std::optional<double> value = core::parse_number(text);
    if (!value) throw core::InputError("expected a number, got '" + text + "'");
    if (!range.contains(*value)) throw core::InputError("must be " + range.text() + ", got " + text);
    return *value;
}

double parse_integer_in(const std::string& text, double min, double max)
{
    const double number = parse_number_in(text, core::Range::between(min, max));
    if (number != std::floor(number)) throw core::InputError("must be whole, got " + text);
    return number;
}

const std::string& check_choice(const std::vector<std::string>& choices, const std::string& text)
{
    if (std::ranges::find(choices, text) != choices.end()) return text;
    const std::string guess = core::nearest_word(text, choices);
    throw core::InputError("'" + text + "' is none of " + core::join(choices, ", ") +
                           (guess.empty() ? "" : "; did you mean '" + guess + "'?"));
}

std::vector<std::string> split_list(const std::string& text)
{
    std::vector<std::string> parts;
    if (text.empty()) return parts;
    std::istringstream rest(text + ","); // the comma makes an empty last part count
    for (std::string part; std::getline(rest, part, ',');) parts.push_back(part);
    return parts;
}

} // namespace fettle::cli
