#include "cli/questions.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <unistd.h>

namespace fettle {

Questions::Questions(bool listens) : listens_(listens), asks_(isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0)
{
}

void Questions::say(const std::string& text) const
{
    if (asks_) std::cerr << text << std::flush;
}

std::string Questions::choose(const std::string& what, const std::vector<std::string>& choices,
                              const std::string& otherwise)
{
    std::string list;
    for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
    return ask(what + " (" + list + ")", otherwise, "none of " + list, [&](const std::string& answer) {
        return std::find(choices.begin(), choices.end(), answer) != choices.end();
    });
}

double Questions::number(const std::string& what, double otherwise)
{
    return *parse_number(ask(what, to_text(otherwise), "no number", [](const std::string& answer) {
        const auto number = parse_number(answer);
        return number && std::isfinite(*number);
    }));
}

std::string Questions::ask(const std::string& what, const std::string& otherwise, const std::string& fault,
                           const std::function<bool(const std::string&)>& fine)
{
    std::string line;
    for (;;) {
        if (listens_) say(what + " [" + otherwise + "]: ");
        if (!listens_ || !std::getline(std::cin, line)) return otherwise;
        const auto parts = words(line);
        if (parts.empty()) return otherwise;
        if (std::string answer(parts[0]); parts.size() == 1 && fine(answer)) return answer;
        if (!asks_) throw InputError("stdin", what + ": " + in_quotes(line) + " is " + fault);
        say(in_quotes(line) + " is " + fault + "\n");
    }
}

} // namespace fettle
