#include "cli/tool.h"

#include "cli/command_line.h"
#include "cli/option.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/version.h"
#include "core/text.h"
#include "core/wrong_kind.h"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <deque>
#include <iostream>
#include <map>
#include <unistd.h>

namespace fettle {

namespace {

constexpr int kMostThreads = 1024;
constexpr int kSeed = 1;
constexpr double kMostSeed = 4294967295; // 32 bits

std::string one_line(std::string message)
{
    const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }; // of the terminal, too
    std::replace_if(message.begin(), message.end(), is_control, ' ');
    while (!message.empty() && message.back() == ' ') message.pop_back();
    return message;
}

} // namespace

struct Tool::State {
    State(int count, char** values, const std::string& text) : app(text), argc(count), argv(values) {}

    CLI::App app;
    int argc;
    char** argv;
    std::string name;
    // A deque never moves its elements: the references that were handed out stay good.
    std::deque<bool> flags;
    std::deque<double> numbers;
    std::deque<std::optional<double>> optional_numbers;
    std::deque<int> counts;
    std::deque<std::string> texts;
    std::deque<std::optional<Units::Length>> units;
    std::map<std::string, std::vector<std::string>> alone; ///< options that need no value, and what it may be
    std::string example;
    std::string reference;

    std::string output = "-";
    std::string report_path;
    double seed = kSeed;
    int threads = 0;
    bool quiet = false;
    bool verbose = false;

    json::Value report;
    std::unique_ptr<tbb::global_control> thread_limit;
    Outputs outputs;
    const std::string* bulk_input = nullptr;
    bool has_output = true;
    std::vector<std::string> warnings;
};

Tool::Tool(int argc, char** argv, const std::string& description)
    : state_(std::make_unique<State>(argc, argv, description))
{
    State& s = *state_;
    const std::string path = argv[0];
    s.name = path.substr(path.find_last_of('/') + 1);
    s.app.name(s.name);
    s.app.set_help_flag("-h,--help", "This help");
    s.app.set_version_flag("--version", s.name + " " + FETTLE_VERSION, "Version");
}

Tool::~Tool() = default;

const std::string& Tool::file(const std::string& name, const std::string& help)
{
    return required_file(name, "FILE", help);
}

const std::string& Tool::input(const std::string& name, const std::string& help)
{
    std::string& value = state_->texts.emplace_back("-");
    state_->bulk_input = &value;
    state_->outputs.protect(value);
    state_->app.add_option(name, value, help + "; stdin if it is - or missing")->type_name("FILE");
    return value;
}

const std::string& Tool::other_file(const std::string& names, const std::string& placeholder, const std::string& help)
{
    const std::string& value = text(names, "", placeholder, help);
    state_->outputs.protect(value);
    return value;
}

const std::string& Tool::required_file(const std::string& names, const std::string& placeholder,
                                       const std::string& help)
{
    const std::string& value = required_text(names, placeholder, help);
    state_->outputs.protect(value);
    return value;
}

const std::string& Tool::other_output(const std::string& names, const std::string& help, const std::string* may_replace)
{
    const std::string& value = text(names, "", "FILE", help);
    state_->outputs.declare(value, may_replace);
    return value;
}

const bool& Tool::flag(const std::string& names, const std::string& help)
{
    bool& value = state_->flags.emplace_back(false);
    state_->app.add_flag(names, value, help)->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    return value;
}

const double& Tool::number(const std::string& names, double otherwise, const std::string& unit, const std::string& help,
                           const Range& range)
{
    double& value = state_->numbers.emplace_back(otherwise);
    add_option(state_->app, names, help, [&value, range](const std::string& text) { value = number_in(text, range); })
        ->type_name(unit)
        ->default_str(to_text(otherwise));
    return value;
}

const std::optional<double>& Tool::number_if_given(const std::string& names, const std::string& unit,
                                                   const std::string& help, const Range& range)
{
    std::optional<double>& value = state_->optional_numbers.emplace_back();
    add_option(state_->app, names, help, [&value, range](const std::string& text) {
        value = number_in(text, range);
    })->type_name(unit);
    return value;
}

const int& Tool::count(const std::string& names, int otherwise, const std::string& help, int least, int most)
{
    int& value = state_->counts.emplace_back(otherwise);
    add_option(state_->app, names, help,
               [&value, least, most](const std::string& text) {
                   value = static_cast<int>(whole_number_in(text, least, most));
               })
        ->type_name("N")
        ->default_str(std::to_string(otherwise));
    return value;
}

const std::string& Tool::text(const std::string& names, const std::string& otherwise, const std::string& placeholder,
                              const std::string& help)
{
    std::string& value = state_->texts.emplace_back(otherwise);
    CLI::Option* option = state_->app.add_option(names, value, help)->type_name(placeholder);
    if (!otherwise.empty()) option->default_str(otherwise);
    return value;
}

const std::string& Tool::required_text(const std::string& names, const std::string& placeholder,
                                       const std::string& help)
{
    std::string& value = state_->texts.emplace_back();
    state_->app.add_option(names, value, help)->type_name(placeholder)->required();
    return value;
}

const std::string& Tool::word(const std::string& name, const std::vector<std::string>& choices, const std::string& help)
{
    std::string& value = state_->texts.emplace_back();
    add_option(state_->app, name, help, [&value, choices](const std::string& text) { value = one_of(choices, text); })
        ->required()
        ->type_name(joined(choices, "|"));
    return value;
}

const std::string& Tool::choice(const std::string& names, const std::string& otherwise,
                                const std::vector<std::string>& choices, const std::string& help)
{
    std::string& value = state_->texts.emplace_back(otherwise);
    CLI::Option* option = add_option(state_->app, names, help,
                                     [&value, choices](const std::string& text) { value = one_of(choices, text); });
    option->type_name(joined(choices, "|"));
    if (!otherwise.empty()) option->default_str(otherwise);
    return value;
}

const std::string& Tool::choice_if_given(const std::string& name, const std::vector<std::string>& choices,
                                         const std::string& help)
{
    state_->alone[name] = choices;
    return choice(name, "", choices, help);
}

const std::optional<Units::Length>& Tool::length_unit(const std::string& names, const std::string& help)
{
    std::optional<Units::Length>& value = state_->units.emplace_back();
    add_option(state_->app, names, help, [&value](const std::string& text) {
        value = parse_length_unit(text);
    })->type_name("mm|in|m");
    return value;
}

void Tool::example(const std::string& command, const std::string& meaning)
{
    state_->example = "Example (in the folder samples/):\n  " + command + "\n      " + meaning;
}

void Tool::reference(const std::string& source) { state_->reference = "Reference: " + source; }

void Tool::without_output() { state_->has_output = false; }

void Tool::parse()
{
    State& s = *state_;
    if (s.has_output)
        s.app.add_option("-o,--output", s.output, "Output; appears whole or not at all")
            ->type_name("FILE")
            ->default_str("stdout");
    s.app.add_option("--report", s.report_path, "Numbers about the run, JSON")->type_name("FILE");
    add_option(s.app, "--seed", "Seed of everything random",
               [&s](const std::string& text) { s.seed = whole_number_in(text, 0, kMostSeed); })
        ->type_name("N")
        ->default_str(std::to_string(kSeed));
    add_option(s.app, "--threads", "Threads; the result does not depend on them",
               [&s](const std::string& text) { s.threads = static_cast<int>(whole_number_in(text, 1, kMostThreads)); })
        ->type_name("N")
        ->default_str("all cores");
    s.app.add_flag("-q,--quiet", s.quiet, "No warnings, no progress")
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    s.app.add_flag("-v,--verbose", s.verbose, "Say what is done")->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    s.app.footer(s.example + (s.reference.empty() ? "" : "\n\n" + s.reference));
    s.app.get_formatter()->column_width(32);
    std::vector<std::string> words = with_values(s.argc, s.argv, s.alone);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    check_options(s.app, static_cast<int>(argv.size()), argv.data());
    s.app.parse(static_cast<int>(argv.size()), argv.data());
    s.outputs.declare(s.report_path, nullptr);
    s.outputs.open(s.has_output ? &s.output : nullptr, s.bulk_input);
    if (s.threads > 0)
        s.thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                               static_cast<std::size_t>(s.threads));
}

std::uint64_t Tool::seed() const { return static_cast<std::uint64_t>(state_->seed); }

std::ostream& Tool::output() { return state_->outputs.bulk(); }

void Tool::claim(const std::string& path) { state_->outputs.claim(path); }

std::ostream& Tool::output_file(const std::string& path) { return state_->outputs.file(path); }

json::Value& Tool::report() { return state_->report; }

void Tool::warn(const std::string& message) const { state_->warnings.push_back(one_line(message)); }

void Tool::note(const std::string& message) const
{
    if (state_->verbose) std::cerr << state_->name << ": " << one_line(message) << '\n';
}

Progress Tool::progress(const std::string& label) const
{
    if (state_->quiet || isatty(STDERR_FILENO) == 0) return {};
    return progress_bar(label);
}

void Tool::finish()
{
    State& s = *state_;
    if (!s.report_path.empty()) output_file(s.report_path) << s.report;
    s.outputs.commit();
    if (s.quiet) return;
    for (const std::string& warning : s.warnings) std::cerr << s.name << ": warning: " << warning << '\n';
}

int tool_main(int argc, char** argv, const std::string& description, const std::function<Verdict(Tool&)>& body)
{
    std::string message;
    std::string name = "fettle";
    prepare_to_write();
    try {
        Tool tool(argc, argv, description);
        name = tool.state_->name;
        try {
            const Verdict verdict = body(tool);
            tool.finish();
            return static_cast<int>(verdict);
        } catch (const CLI::Success& success) { // --help and --version
            OutputFile out("-");
            if (dynamic_cast<const CLI::CallForHelp*>(&success) != nullptr)
                out.stream() << tool.state_->app.help();
            else
                out.stream() << name << ' ' << FETTLE_VERSION << "\nBuilt with " << built_with() << '\n';
            out.commit();
            return 0;
        } catch (const WrongKind& error) {
            message = error.what() + order_of_arguments(tool.state_->app, error.file);
        } catch (const CLI::ExtrasError&) {
            message = "unexpected argument '" + tool.state_->app.remaining().front() + "' (see " + name + " --help)";
        } catch (const CLI::ParseError& error) {
            message = std::string(error.what()) + " (see " + name + " --help)";
        }
    } catch (const InputError& error) {
        message = error.what();
    } catch (const std::bad_alloc&) {
        message = "out of memory";
    } catch (const std::exception& error) {
        message = std::string("internal error: ") + error.what();
    }
    std::cerr << name << ": " << one_line(message) << '\n';
    return 2;
}

} // namespace fettle
