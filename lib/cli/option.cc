#include "cli/option.h"

#include "cli/tool_state.h"
#include "core/error.h"
#include "core/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
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

// --- declarations of a tool's options (cli/tool.h)
// ---------------------------------------------------------------------

const std::string& Tool::positional_file(const std::string& name, const std::string& help)
{
    return required_file_option(name, "FILE", help);
}

const std::vector<std::string>& Tool::positional_files(const std::string& name, const std::string& help)
{
    std::vector<std::string>& values = state_->file_lists.emplace_back();
    state_->app->add_option(name, values, help)->type_name("FILE")->required();
    return values;
}

const std::string& Tool::main_input(const std::string& name, const std::string& help)
{
    std::string& value = state_->texts.emplace_back("-");
    state_->main_input = &value;
    state_->outputs.add_input(value);
    state_->app->add_option(name, value, help + "; stdin if it is - or missing")->type_name("FILE");
    return value;
}

const std::string& Tool::optional_file(const std::string& names, const std::string& placeholder,
                                       const std::string& help)
{
    const std::string& value = text(names, "", placeholder, help);
    state_->outputs.add_input(value);
    return value;
}

const std::string& Tool::required_file_option(const std::string& names, const std::string& placeholder,
                                              const std::string& help)
{
    const std::string& value = required_text(names, placeholder, help);
    state_->outputs.add_input(value);
    return value;
}

const std::string& Tool::optional_output(const std::string& names, const std::string& help,
                                         const std::vector<std::string>& formats, const std::string* may_replace)
{
    const std::string& value = text(names, "", "FILE", help);
    state_->file_formats.push_back({&value, formats});
    state_->outputs.declare(value, may_replace);
    return value;
}

const bool& Tool::flag(const std::string& names, const std::string& help)
{
    bool& value = state_->flags.emplace_back(false);
    state_->app->add_flag(names, value, help)->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    return value;
}

const double& Tool::number(const std::string& names, double fallback, const std::string& unit, const std::string& help,
                           const core::Range& range)
{
    double& value = state_->numbers.emplace_back(fallback);
    add_option(*state_->app, names, help,
               [&value, range](const std::string& text) { value = parse_number_in(text, range); })
        ->type_name(unit)
        ->default_str(core::to_text(fallback));
    return value;
}

const std::optional<double>& Tool::optional_number(const std::string& names, const std::string& unit,
                                                   const std::string& help, const core::Range& range)
{
    std::optional<double>& value = state_->optional_numbers.emplace_back();
    add_option(*state_->app, names, help, [&value, range](const std::string& text) {
        value = parse_number_in(text, range);
    })->type_name(unit);
    return value;
}

const int& Tool::count(const std::string& names, int fallback, const std::string& help, int min, int max)
{
    int& value = state_->counts.emplace_back(fallback);
    add_option(
        *state_->app, names, help,
        [&value, min, max](const std::string& text) { value = static_cast<int>(parse_integer_in(text, min, max)); })
        ->type_name("N")
        ->default_str(std::to_string(fallback));
    return value;
}

const std::string& Tool::text(const std::string& names, const std::string& fallback, const std::string& placeholder,
                              const std::string& help)
{
    std::string& value = state_->texts.emplace_back(fallback);
    CLI::Option* option = state_->app->add_option(names, value, help)->type_name(placeholder);
    if (!fallback.empty()) option->default_str(fallback);
    return value;
}

const std::vector<std::string>& Tool::repeated_text(const std::string& names, const std::string& placeholder,
                                                    const std::string& help)
{
    std::vector<std::string>& values = state_->text_lists.emplace_back();
    state_->app->add_option(names, values, help)->type_name(placeholder)->allow_extra_args(false);
    return values;
}

const std::vector<std::string>& Tool::file_list(const std::string& names, const std::string& help)
{
    std::vector<std::string>& values = state_->file_lists.emplace_back();
    state_->app->add_option(names, values, help)->type_name("FILE")->expected(1, std::numeric_limits<short>::max());
    return values;
}

const std::string& Tool::required_text(const std::string& names, const std::string& placeholder,
                                       const std::string& help)
{
    std::string& value = state_->texts.emplace_back();
    state_->app->add_option(names, value, help)->type_name(placeholder)->required();
    return value;
}

const std::string& Tool::positional_choice(const std::string& name, const std::vector<std::string>& choices,
                                           const std::string& help)
{
    std::string& value = state_->texts.emplace_back();
    add_option(*state_->app, name, help,
               [&value, choices](const std::string& text) { value = check_choice(choices, text); })
        ->required()
        ->type_name(core::join(choices, "|"));
    return value;
}

void Tool::declare_choice(const std::string& names, const std::string& fallback,
                          const std::vector<std::string>& choices, const std::string& help,
                          const std::function<void(const std::string&)>& set)
{
    CLI::Option* option = add_option(*state_->app, names, help,
                                     [set, choices](const std::string& text) { set(check_choice(choices, text)); });
    option->type_name(core::join(choices, "|"));
    if (!fallback.empty()) option->default_str(fallback);
}

const std::string& Tool::choice(const std::string& names, const std::string& fallback,
                                const std::vector<std::string>& choices, const std::string& help)
{
    std::string& value = state_->texts.emplace_back(fallback);
    declare_choice(names, fallback, choices, help, [&value](const std::string& text) { value = text; });
    return value;
}

const std::string& Tool::optional_choice(const std::string& name, const std::vector<std::string>& choices,
                                         const std::string& help)
{
    state_->optional_values[name] = choices;
    return choice(name, "", choices, help);
}

const std::optional<units::Units::Length>& Tool::length_unit(const std::string& names, const std::string& help)
{
    std::optional<units::Units::Length>& value = state_->units.emplace_back();
    add_option(*state_->app, names, help, [&value](const std::string& text) {
        value = units::parse_length_unit(text);
    })->type_name("mm|in|m");
    return value;
}

} // namespace fettle::cli
