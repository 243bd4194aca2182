#include "cli/command_line.h"

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>

namespace fettle::cli {

namespace {

bool is_number(const std::string& word) { return core::parse_number(word).has_value(); }

bool looks_like_option(const std::string& word)
{
    return word.size() > 1 && word[0] == '-' && !is_number(word) && !is_number(word.substr(0, word.find(',')));
}

/// "-o" of "-oFILE", "--output" of "--output=FILE".
std::string option_name(const std::string& word)
{
    return word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

bool has_value_attached(const std::string& word)
{
    return word.starts_with("--") ? word.find('=') != std::string::npos : word.size() > 2;
}

[[noreturn]] void refuse_unknown(const CLI::App& app, const std::string& name)
{
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& word : option->get_lnames()) known.push_back("--" + word);
    std::string guess = core::nearest_word(name, known);
    for (const std::string& word : known) // a missing or additional word is beyond the edit distance
        if (guess.empty() && name.size() > 3 && (word.starts_with(name) || name.starts_with(word))) guess = word;
    throw core::InputError("unknown option '" + name + "'" + (guess.empty() ? "" : ", did you mean '" + guess + "'?"));
}

} // namespace

void check_options(const CLI::App& app, int argc, char** argv)
{
    const std::vector<std::string> words(argv + 1, argv + argc);
    std::set<const CLI::Option*> seen;
    for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
        if (!looks_like_option(words[i])) continue;
        const std::string name = option_name(words[i]);
        const CLI::Option* option = app.get_option_no_throw(name);
        if (option == nullptr) refuse_unknown(app, name);
        if (option == app.get_help_ptr()) return;
        if (!seen.insert(option).second && option->get_expected_max() <= 1)
            throw core::InputError("option " + name + " is given twice");
        if (option->get_expected_max() == 0) continue;
        if (has_value_attached(words[i]) && !words[i].ends_with('=')) continue;
        const std::string next = has_value_attached(words[i]) || i + 1 == words.size() ? "" : words[i + 1];
        const bool has_value = !next.empty() && next != "--" &&
                               !(looks_like_option(next) && app.get_option_no_throw(option_name(next)) != nullptr);
        if (!has_value) throw core::InputError("option " + name + ": value missing");
        ++i;
    }
}

std::vector<std::string> attach_optional_values(int argc, char** argv,
                                                const std::map<std::string, std::vector<std::string>>& choices_of)
{
    std::vector<std::string> words;
    bool options = true; // false after "--"
    for (int i = 0; i < argc; ++i) {
        const std::string word = words.emplace_back(argv[i]);
        options = options && word != "--";
        const auto option = choices_of.find(word);
        if (!options || option == choices_of.end()) continue;
        const std::vector<std::string>& choices = option->second;
        const bool has_value = i + 1 < argc && std::ranges::find(choices, argv[i + 1]) != choices.end();
        words.back() += "=" + (has_value ? std::string(argv[++i]) : choices.front());
    }
    return words;
}

std::string describe_argument_order(const CLI::App& app, const std::string& file)
{
    std::string list;
    int arguments = 0;
    bool is_argument = false;
    for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return o->get_positional(); })) {
        const std::string name = option->get_name();
        list += " " + (option->get_required() ? name : "[" + name + "]");
        is_argument |= file == core::display_name(option->empty() ? "-" : option->results().back());
        ++arguments;
    }
    return is_argument && arguments > 1 ? " (the arguments are" + list + ")" : "";
}

} // namespace fettle::cli
