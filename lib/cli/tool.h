#pragma once

#include "core/error.h"
#include "core/progress.h"
#include "core/range.h"
#include "units/units.h"
#include "json/document.h"

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle::cli {

/// Exit status of a tool that has run. Bad input and usage (2) are exceptions.
enum class Verdict { yes = 0, no = 1 };

/// Command line and outputs of a tool. All arguments are declared first; each declaration returns a reference to the
/// value, which parse() sets. Help, defaults and range checks follow from the declarations. Every tool has -o,
/// --report, --seed,
/// --threads, -q, -v, --help and --version.
///
/// Names are as on the command line, "-t,--tolerance". An option may be given only once.
class Tool {
  public:
    /// A required positional file, in order of declaration: fettle-fit JOB
    const std::string& positional_file(const std::string& name, const std::string& help);
    /// Positional files, at least one, after all others: fettle-merge SCAN…
    const std::vector<std::string>& positional_files(const std::string& name, const std::string& help);
    /// A required positional word out of `choices`, in order with the positional files: fettle-form flatness
    const std::string& positional_choice(const std::string& name, const std::vector<std::string>& choices,
                                         const std::string& help);
    /// The main input, an optional last positional file; "-" or nothing is stdin.
    const std::string& main_input(const std::string& name, const std::string& help);

    /// An input file named by an option; empty if not given. "-" is stdin.
    const std::string& optional_file(const std::string& names, const std::string& placeholder, const std::string& help);
    /// An input file named by a required option.
    const std::string& required_file_option(const std::string& names, const std::string& placeholder,
                                            const std::string& help);

    /// An output file named by an option, to be written with output_file(); empty if not given. parse() throws if it
    /// cannot be written.
    /// @param formats  suffixes that its name may have (cli/output_format.h); none: any
    /// @param may_replace  the input that it is derived from and may replace, if there is one
    const std::string& optional_output(const std::string& names, const std::string& help,
                                       const std::vector<std::string>& formats,
                                       const std::string* may_replace = nullptr);

    const bool& flag(const std::string& names, const std::string& help);
    const double& number(const std::string& names, double fallback, const std::string& unit, const std::string& help,
                         const core::Range& range = {});
    const std::optional<double>& optional_number(const std::string& names, const std::string& unit,
                                                 const std::string& help, const core::Range& range = {});
    const int& count(const std::string& names, int fallback, const std::string& help, int min, int max);
    /// Any text. @param placeholder  name of the value in the help
    const std::string& text(const std::string& names, const std::string& fallback, const std::string& placeholder,
                            const std::string& help);
    /// Any texts, of an option that may be given several times.
    const std::vector<std::string>& repeated_text(const std::string& names, const std::string& placeholder,
                                                  const std::string& help);
    /// Input files named by one option, one after the other.
    const std::vector<std::string>& file_list(const std::string& names, const std::string& help);
    /// Any text, of a required option.
    const std::string& required_text(const std::string& names, const std::string& placeholder, const std::string& help);
    const std::string& choice(const std::string& names, const std::string& fallback,
                              const std::vector<std::string>& choices, const std::string& help);
    /// A choice whose words stand for values, such as those of an enumeration; the first word is the default.
    template <typename Value>
    const Value& choice(const std::string& names, const std::vector<std::pair<std::string, Value>>& choices,
                        const std::string& help)
    {
        const auto value = std::make_shared<Value>(choices.front().second); // shared with the parser of the option
        std::vector<std::string> words;
        for (const auto& [word, meaning] : choices) words.push_back(word);
        declare_choice(names, words.front(), words, help, [value, choices](const std::string& given) {
            for (const auto& [word, meaning] : choices)
                if (word == given) *value = meaning;
        });
        return *value;
    }
    /// A choice whose option may be given without a value, which means the first choice; empty if the option is not
    /// given.
    const std::string& optional_choice(const std::string& name, const std::vector<std::string>& choices,
                                       const std::string& help);
    /// Length unit of a file: mm, in or m; nothing if not given.
    const std::optional<units::Units::Length>& length_unit(const std::string& names, const std::string& help);

    /// Example for the help: a command line that runs in the folder samples/.
    void example(const std::string& command, const std::string& meaning);
    /// Reference for the help: a paper and its section or equations.
    void reference(const std::string& source);

    /// Formats of the main output, as suffixes in lower case. parse() throws if -o has another suffix.
    void output_formats(const std::vector<std::string>& formats);
    /// Declares --format, which takes one of these, too.
    /// @param otherwise  help: what is written without that option and a suffix; empty: the first format
    /// @return  the format, by that option or by the suffix of -o; without both the first, or with `otherwise` none
    const std::string& output_format(const std::vector<std::string>& formats, const std::string& otherwise = "");

    /// Declares no option -o, for tools that use stdout for a protocol.
    void disable_output();

    /// Parses the command line and opens the outputs. Must follow all declarations.
    void parse();

    std::uint64_t seed() const;

    /// Name of the main output, "-" for stdout: its suffix may say in which format to write.
    const std::string& output_name() const;
    /// The main output: -o FILE, or stdout. It is written atomically when the tool has ended without an exception.
    std::ostream& output();
    /// Another output, also written atomically.
    /// @throws InputError as claim()
    std::ostream& output_file(const std::string& path);
    /// Reserves the name of a file that is not written through output() or output_file().
    /// @throws InputError if it names another output, or an input, which would be lost; only the main output may
    /// replace the main input
    void reserve_output(const std::string& path);
    /// Report of the run, written to the file of --report.
    json::Value& report();

    /// Prints a warning on stderr, unless -q is given. Warnings are printed at the end and only if the tool succeeds,
    /// so that an error is a single line.
    void warn(const std::string& message) const;
    /// Prints a machine's fault on stderr, with -q, too: the tool has written what was done until then, and its verdict
    /// is no. Faults are printed after the warnings.
    void fault(const std::string& message) const;
    /// Prints a line on stderr if -v is given.
    void note(const std::string& message) const;
    /// True if stderr is a terminal, and -q is not given.
    bool shows_progress() const;
    /// Progress bar on stderr, if that is a terminal and the computation takes longer than a second.
    core::Progress progress(const std::string& label) const;

  private:
    friend int tool_main(int, char**, const std::string&, const std::function<Verdict(Tool&)>&);
    struct State;
    Tool(int argc, char** argv, const std::string& description);
    ~Tool();
    void declare_choice(const std::string& names, const std::string& fallback, const std::vector<std::string>& choices,
                        const std::string& help, const std::function<void(const std::string&)>& set);
    void finish();
    std::unique_ptr<State> state_;
};

using core::with_error_prefix;

/// Runs a tool. Exceptions are printed on one line, "fettle-NAME: message".
/// @return  exit status: 0 or 1 by the verdict, 2 for bad input or usage, or a failed write
int tool_main(int argc, char** argv, const std::string& description, const std::function<Verdict(Tool&)>& body);

} // namespace fettle::cli
