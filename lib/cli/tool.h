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
#include <vector>

namespace fettle {

/// What a tool answers by its exit status. Bad input and usage (2) are exceptions.
enum class Verdict { yes = 0, no = 1 };

/// The command line of one tool. First declare everything; each declaration returns a reference that holds the value
/// once parse() has run. Help, defaults and range checks follow from the declarations. Every tool has -o, --report,
/// --seed, --threads, -q, -v, --help and --version.
///
/// Names are as on the command line, "-t,--tolerance". An option given twice is refused.
class Tool {
  public:
    /// A named file that must be given, in order of declaration: fettle-fit JOB
    const std::string& file(const std::string& name, const std::string& help);
    /// A word out of `choices` that must be given, in order with the named files: fettle-form flatness
    const std::string& word(const std::string& name, const std::vector<std::string>& choices, const std::string& help);
    /// The bulk input, after the named files; "-" or nothing is stdin.
    const std::string& input(const std::string& name, const std::string& help);

    /// A file that an option names, and that is read; it may be left out. What goes on stdin is the bulk input, or "-"
    /// here.
    const std::string& other_file(const std::string& names, const std::string& placeholder, const std::string& help);
    /// As other_file, but it must be given.
    const std::string& required_file(const std::string& names, const std::string& placeholder, const std::string& help);

    /// A file that an option names, and that is written with output_file(); it may be left out. parse() looks whether
    /// it can be, before any work.
    /// @param may_replace  the input that it is made of and whose place it may take, if there is one
    const std::string& other_output(const std::string& names, const std::string& help,
                                    const std::string* may_replace = nullptr);

    const bool& flag(const std::string& names, const std::string& help);
    const double& number(const std::string& names, double otherwise, const std::string& unit, const std::string& help,
                         const Range& range = {});
    const std::optional<double>& number_if_given(const std::string& names, const std::string& unit,
                                                 const std::string& help, const Range& range = {});
    const int& count(const std::string& names, int otherwise, const std::string& help, int least, int most);
    /// Free text or a file name; `placeholder` stands for it in the help ("FILE").
    const std::string& text(const std::string& names, const std::string& otherwise, const std::string& placeholder,
                            const std::string& help);
    /// As text, but it must be given.
    const std::string& required_text(const std::string& names, const std::string& placeholder, const std::string& help);
    const std::string& choice(const std::string& names, const std::string& otherwise,
                              const std::vector<std::string>& choices, const std::string& help);
    /// May stand alone, which is the first of the choices, or before one of them; empty: it is not given.
    const std::string& choice_if_given(const std::string& name, const std::vector<std::string>& choices,
                                       const std::string& help);
    /// mm, in or m: the unit of a file; nothing if not given.
    const std::optional<Units::Length>& length_unit(const std::string& names, const std::string& help);

    /// A command line that runs as pasted in the folder samples/, for the help.
    void example(const std::string& command, const std::string& meaning);
    /// The paper and its section or equations, for the help.
    void reference(const std::string& source);

    /// stdout is a conversation: there is no -o.
    void without_output();

    /// Reads the command line. After it nothing can be declared.
    void parse();

    std::uint64_t seed() const;

    /// The bulk output: -o FILE, or stdout. It appears whole when the tool has ended without an exception, or not at
    /// all.
    std::ostream& output();
    /// Another output, named by an option; whole or not at all, too.
    /// @throws InputError as claim()
    std::ostream& output_file(const std::string& path);
    /// A file that is written by the work itself.
    /// @throws InputError if it is another output, or an input: that would be lost. Only the bulk output may take the
    /// place of the bulk input.
    void claim(const std::string& path);
    /// Numbers about the run, written where --report says.
    json::Value& report();

    /// One line on stderr that matters although the work goes on, said when it has ended: a refusal stays one line.
    /// Silent with -q.
    void warn(const std::string& message) const;
    /// One line on stderr with -v.
    void note(const std::string& message) const;
    /// A progress bar on stderr, if that is a terminal and the work takes longer than a second.
    Progress progress(const std::string& label) const;

  private:
    friend int tool_main(int, char**, const std::string&, const std::function<Verdict(Tool&)>&);
    struct State;
    Tool(int argc, char** argv, const std::string& description);
    ~Tool();
    void finish();
    std::unique_ptr<State> state_;
};

/// What work returns; an option's or a file's name goes before what the library has against its value, unless an option
/// is named already.
template <typename Work>
auto named(const std::string& name, const Work& work)
{
    try {
        return work();
    } catch (const InputError& error) {
        if (std::string(error.what()).starts_with("--")) throw;
        throw InputError(name, error.what());
    }
}

/// Runs a tool: catches what the library throws, prints "fettle-NAME: message" in one line and returns the exit status:
/// 0 or 1 by the verdict, 2 for bad input, usage, or a failed write.
int tool_main(int argc, char** argv, const std::string& description, const std::function<Verdict(Tool&)>& body);

} // namespace fettle
