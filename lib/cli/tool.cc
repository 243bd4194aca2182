#include "cli/tool.h"

#include "cli/command_line.h"
#include "cli/option.h"
#include "cli/output_format.h"
#include "cli/progress_bar.h"
#include "cli/tool_state.h"
#include "cli/version.h"
#include "core/text.h"
#include "core/wrong_kind.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <unistd.h>

namespace fettle::cli {

namespace {

constexpr int kMaxThreads = 1024;
constexpr double kMaxSeed = 4294967295; // 32 bits

std::string one_line(std::string message)
{
    const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }; // also terminal escapes
    std::replace_if(message.begin(), message.end(), is_control, ' ');
    while (!message.empty() && message.back() == ' ') message.pop_back();
    return message;
}

} // namespace

Tool::State::State(int count, char** values, const std::string& description)
    : app(std::make_unique<CLI::App>(description)), argc(count), argv(values)
{
}
Tool::State::~State() = default;

void Tool::State::check_formats()
{
    if (!output_formats.empty()) {
        const std::string by_suffix = format_of_output(output, output_formats);
        if (!by_suffix.empty() && !format.empty() && format != by_suffix)
            throw core::InputError(output, "'." + by_suffix + "' is not the suffix of --format " + format);
        if (format.empty()) format = by_suffix.empty() ? default_format : by_suffix;
    }
    for (const auto& [path, formats] : file_formats)
        if (!path->empty() && !formats.empty()) format_of_output(*path, formats);
    if (!report_path.empty()) format_of_output(report_path, {"json"});
}

Tool::Tool(int argc, char** argv, const std::string& description)
    : state_(std::make_unique<State>(argc, argv, description))
{
    State& s = *state_;
    const std::string path = argv[0];
    s.name = path.substr(path.find_last_of('/') + 1);
    s.app->name(s.name);
    s.app->set_help_flag("-h,--help", "This help");
    s.app->set_version_flag("--version", s.name + " " + FETTLE_VERSION, "Version");
}

Tool::~Tool() = default;

void Tool::example(const std::string& command, const std::string& meaning)
{
    state_->example = "Example (in the folder samples/):\n  " + command + "\n      " + meaning;
}

void Tool::reference(const std::string& source) { state_->reference = "Reference: " + source; }

void Tool::output_formats(const std::vector<std::string>& formats) { state_->output_formats = formats; }

const std::string& Tool::output_format(const std::vector<std::string>& formats, const std::string& otherwise)
{
    output_formats(formats);
    if (otherwise.empty()) state_->default_format = formats.front();
    declare_choice("--format", "", formats,
                   "Format of the output; default: by the suffix of -o, else " +
                       (otherwise.empty() ? formats.front() : otherwise),
                   [this](const std::string& word) { state_->format = word; });
    return state_->format;
}

void Tool::disable_output() { state_->has_output = false; }

void Tool::parse()
{
    State& s = *state_;
    if (s.has_output)
        s.app
            ->add_option("-o,--output", s.output,
                         "Output, written atomically" +
                             (s.output_formats.empty() ? "" : ": ." + core::join(s.output_formats, ", .")))
            ->type_name("FILE")
            ->default_str("stdout");
    s.app->add_option("--report", s.report_path, "Numbers about the run, JSON")->type_name("FILE");
    add_option(*s.app, "--seed", "Seed of all random numbers",
               [&s](const std::string& text) { s.seed = parse_integer_in(text, 0, kMaxSeed); })
        ->type_name("N")
        ->default_str(std::to_string(kDefaultSeed));
    add_option(*s.app, "--threads", "Threads; the result does not depend on them",
               [&s](const std::string& text) { s.threads = static_cast<int>(parse_integer_in(text, 1, kMaxThreads)); })
        ->type_name("N")
        ->default_str("all cores");
    s.app->add_flag("-q,--quiet", s.quiet, "No warnings, no progress")
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    s.app->add_flag("-v,--verbose", s.verbose, "Print notes about the run")
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    s.app->footer(s.example + (s.reference.empty() ? "" : "\n\n" + s.reference));
    s.app->get_formatter()->column_width(32);
    std::vector<std::string> words = attach_optional_values(s.argc, s.argv, s.optional_values);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    check_options(*s.app, static_cast<int>(argv.size()), argv.data());
    s.app->parse(static_cast<int>(argv.size()), argv.data());
    for (const std::vector<std::string>& files : s.file_lists)
        for (const std::string& file : files) s.outputs.add_input(file);
    s.check_formats();
    s.outputs.declare(s.report_path, nullptr);
    s.outputs.open(s.has_output ? &s.output : nullptr, s.main_input);
    if (s.threads > 0)
        s.thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                               static_cast<std::size_t>(s.threads));
}

std::uint64_t Tool::seed() const { return static_cast<std::uint64_t>(state_->seed); }

const std::string& Tool::output_name() const { return state_->output; }

std::ostream& Tool::output() { return state_->outputs.main(); }

void Tool::reserve_output(const std::string& path) { state_->outputs.reserve(path); }

std::ostream& Tool::output_file(const std::string& path) { return state_->outputs.file(path); }

json::Value& Tool::report() { return state_->report; }

void Tool::warn(const std::string& message) const { state_->warnings.push_back(one_line(message)); }

void Tool::fault(const std::string& message) const { state_->faults.push_back(one_line(message)); }

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
    if (!s.quiet)
        for (const std::string& warning : s.warnings) std::cerr << s.name << ": warning: " << warning << '\n';
    for (const std::string& fault : s.faults) std::cerr << s.name << ": " << fault << '\n';
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
                out.stream() << tool.state_->app->help();
            else
                out.stream() << name << ' ' << FETTLE_VERSION << "\nBuilt with " << describe_build() << '\n';
            out.commit();
            return 0;
        } catch (const core::WrongFileType& error) {
            message = error.what() + describe_argument_order(*tool.state_->app, error.file);
        } catch (const CLI::ExtrasError&) {
            message = "unexpected argument '" + tool.state_->app->remaining().front() + "' (see " + name + " --help)";
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
