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

namespace fettle::cli {

namespace {

constexpr int kMaxThreads = 1024;
constexpr int kDefaultSeed = 1;
constexpr double kMaxSeed = 4294967295; // 32 bits

std::string one_line(std::string message)
{
    const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }; // also terminal escapes
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
    // Appending to a deque keeps references valid, which the declarations return.
    std::deque<bool> flags;
    std::deque<double> numbers;
    std::deque<std::optional<double>> optional_numbers;
    std::deque<int> counts;
    std::deque<std::string> texts;
    std::deque<std::optional<units::Units::Length>> units;
    std::map<std::string, std::vector<std::string>> optional_values; ///< choices of options with an optional value
    std::string example;
    std::string reference;

    std::string output = "-";
    std::string report_path;
    double seed = kDefaultSeed;
    int threads = 0;
    bool quiet = false;
    bool verbose = false;

    json::Value report;
    std::unique_ptr<tbb::global_control> thread_limit;
    Outputs outputs;
    const std::string* main_input = nullptr;
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

const std::string& Tool::positional_file(const std::string& name, const std::string& help)
{
    return required_file_option(name, "FILE", help);
}

const std::string& Tool::main_input(const std::string& name, const std::string& help)
{
    std::string& value = state_->texts.emplace_back("-");
    state_->main_input = &value;
    state_->outputs.add_input(value);
    state_->app.add_option(name, value, help + "; stdin if it is - or missing")->type_name("FILE");
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
                                         const std::string* may_replace)
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

const double& Tool::number(const std::string& names, double fallback, const std::string& unit, const std::string& help,
                           const core::Range& range)
{
    double& value = state_->numbers.emplace_back(fallback);
    add_option(state_->app, names, help,
               [&value, range](const std::string& text) { value = parse_number_in(text, range); })
        ->type_name(unit)
        ->default_str(core::to_text(fallback));
    return value;
}

const std::optional<double>& Tool::optional_number(const std::string& names, const std::string& unit,
                                                   const std::string& help, const core::Range& range)
{
    std::optional<double>& value = state_->optional_numbers.emplace_back();
    add_option(state_->app, names, help, [&value, range](const std::string& text) {
        value = parse_number_in(text, range);
    })->type_name(unit);
    return value;
}

const int& Tool::count(const std::string& names, int fallback, const std::string& help, int min, int max)
{
    int& value = state_->counts.emplace_back(fallback);
    add_option(
        state_->app, names, help,
        [&value, min, max](const std::string& text) { value = static_cast<int>(parse_integer_in(text, min, max)); })
        ->type_name("N")
        ->default_str(std::to_string(fallback));
    return value;
}

const std::string& Tool::text(const std::string& names, const std::string& fallback, const std::string& placeholder,
                              const std::string& help)
{
    std::string& value = state_->texts.emplace_back(fallback);
    CLI::Option* option = state_->app.add_option(names, value, help)->type_name(placeholder);
    if (!fallback.empty()) option->default_str(fallback);
    return value;
}

const std::string& Tool::required_text(const std::string& names, const std::string& placeholder,
                                       const std::string& help)
{
    std::string& value = state_->texts.emplace_back();
    state_->app.add_option(names, value, help)->type_name(placeholder)->required();
    return value;
}

const std::string& Tool::positional_choice(const std::string& name, const std::vector<std::string>& choices,
                                           const std::string& help)
{
    std::string& value = state_->texts.emplace_back();
    add_option(state_->app, name, help,
               [&value, choices](const std::string& text) { value = check_choice(choices, text); })
        ->required()
        ->type_name(core::join(choices, "|"));
    return value;
}

void Tool::declare_choice(const std::string& names, const std::string& fallback,
                          const std::vector<std::string>& choices, const std::string& help,
                          const std::function<void(const std::string&)>& set)
{
    CLI::Option* option = add_option(state_->app, names, help,
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
    add_option(state_->app, names, help, [&value](const std::string& text) {
        value = units::parse_length_unit(text);
    })->type_name("mm|in|m");
    return value;
}

void Tool::example(const std::string& command, const std::string& meaning)
{
    state_->example = "Example (in the folder samples/):\n  " + command + "\n      " + meaning;
}

void Tool::reference(const std::string& source) { state_->reference = "Reference: " + source; }

void Tool::disable_output() { state_->has_output = false; }

void Tool::parse()
{
    State& s = *state_;
    if (s.has_output)
        s.app.add_option("-o,--output", s.output, "Output, written atomically")
            ->type_name("FILE")
            ->default_str("stdout");
    s.app.add_option("--report", s.report_path, "Numbers about the run, JSON")->type_name("FILE");
    add_option(s.app, "--seed", "Seed of all random numbers",
               [&s](const std::string& text) { s.seed = parse_integer_in(text, 0, kMaxSeed); })
        ->type_name("N")
        ->default_str(std::to_string(kDefaultSeed));
    add_option(s.app, "--threads", "Threads; the result does not depend on them",
               [&s](const std::string& text) { s.threads = static_cast<int>(parse_integer_in(text, 1, kMaxThreads)); })
        ->type_name("N")
        ->default_str("all cores");
    s.app.add_flag("-q,--quiet", s.quiet, "No warnings, no progress")
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    s.app.add_flag("-v,--verbose", s.verbose, "Print notes about the run")
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    s.app.footer(s.example + (s.reference.empty() ? "" : "\n\n" + s.reference));
    s.app.get_formatter()->column_width(32);
    std::vector<std::string> words = attach_optional_values(s.argc, s.argv, s.optional_values);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    check_options(s.app, static_cast<int>(argv.size()), argv.data());
    s.app.parse(static_cast<int>(argv.size()), argv.data());
    s.outputs.declare(s.report_path, nullptr);
    s.outputs.open(s.has_output ? &s.output : nullptr, s.main_input);
    if (s.threads > 0)
        s.thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                               static_cast<std::size_t>(s.threads));
}

std::uint64_t Tool::seed() const { return static_cast<std::uint64_t>(state_->seed); }

std::ostream& Tool::output() { return state_->outputs.main(); }

void Tool::reserve_output(const std::string& path) { state_->outputs.reserve(path); }

std::ostream& Tool::output_file(const std::string& path) { return state_->outputs.file(path); }

json::Value& Tool::report() { return state_->report; }

void Tool::warn(const std::string& message) const { state_->warnings.push_back(one_line(message)); }

void Tool::note(const std::string& message) const
{
    if (state_->verbose) std::cerr << state_->name << ": " << one_line(message) << '\n';
}

bool Tool::shows_progress() const { return !state_->quiet && isatty(STDERR_FILENO) != 0; }

core::Progress Tool::progress(const std::string& label) const
{
    if (!shows_progress()) return {};
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
    guard_standard_streams();
    try {
        Tool tool(argc, argv, description);
        name = tool.state_->name;
        try {
            const Verdict verdict = body(tool);
            tool.finish();
            return static_cast<int>(verdict);
        } catch (const CLI::Success& success) { // --help and --version
            core::OutputFile out("-");
            if (dynamic_cast<const CLI::CallForHelp*>(&success) != nullptr)
                out.stream() << tool.state_->app.help();
            else
                out.stream() << name << ' ' << FETTLE_VERSION << "\nBuilt with " << describe_build() << '\n';
            out.commit();
            return 0;
        } catch (const core::WrongFileType& error) {
            message = error.what() + describe_argument_order(tool.state_->app, error.file);
        } catch (const CLI::ExtrasError&) {
            message = "unexpected argument '" + tool.state_->app.remaining().front() + "' (see " + name + " --help)";
        } catch (const CLI::ParseError& error) {
            message = std::string(error.what()) + " (see " + name + " --help)";
        }
    } catch (const core::InputError& error) {
        message = error.what();
    } catch (const std::bad_alloc&) {
        message = "out of memory";
    } catch (const std::exception& error) {
        message = std::string("internal error: ") + error.what();
    }
    std::cerr << name << ": " << one_line(message) << '\n';
    return 2;
}

} // namespace fettle::cli
