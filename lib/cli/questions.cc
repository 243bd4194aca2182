#include "cli/questions.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <unistd.h>

namespace fettle::cli {

OperatorPrompt::OperatorPrompt(bool reads_stdin)
    : reads_stdin_(reads_stdin), is_interactive_(isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0)
{
}

void OperatorPrompt::print_hint(const std::string& text) const
{
    if (is_interactive_) std::cerr << text << std::flush;
}

std::string OperatorPrompt::ask_choice(const std::string& what, const std::vector<std::string>& choices,
                                       const std::string& fallback)
{
    const std::string list = core::join(choices, ", ");
    return ask(what + " (" + list + ")", fallback, "none of " + list,
               [&](const std::string& answer) { return std::ranges::find(choices, answer) != choices.end(); });
}

double OperatorPrompt::ask_number(const std::string& what, double fallback)
{
    return *core::parse_number(ask(what, core::to_text(fallback), "not a number", [](const std::string& answer) {
        const auto number = core::parse_number(answer);
        return number && std::isfinite(*number);
    }));
}

std::string OperatorPrompt::ask(const std::string& what, const std::string& fallback, const std::string& fault,
                                const std::function<bool(const std::string&)>& is_valid)
{
    std::string line;
    for (;;) {
        if (reads_stdin_) print_hint(what + " [" + fallback + "]: ");
        if (!reads_stdin_ || !std::getline(std::cin, line)) return fallback;
        const auto parts = core::words(line);
        if (parts.empty()) return fallback;
        if (std::string answer(parts[0]); parts.size() == 1 && is_valid(answer)) return answer;
        if (!is_interactive_) throw core::InputError("stdin", what + ": " + core::in_quotes(line) + " is " + fault);
        print_hint(core::in_quotes(line) + " is " + fault + "\n");
    }
}

} // namespace fettle::cli
