#include "cli/screen.h"

#include <algorithm>
#include <iostream>
#include <unistd.h>

namespace fettle::cli {
namespace {

// Control sequences of ECMA-48, and xterm's for the alternate screen, which terminals and tmux have.
constexpr const char* kEnter = "\033[?1049h\033[?25l"; // alternate screen, no cursor
constexpr const char* kLeave = "\033[?25h\033[?1049l";
constexpr const char* kHome = "\033[H";
constexpr const char* kClearRestOfLine = "\033[K";
constexpr const char* kClearBelow = "\033[J";

} // namespace

TerminalScreen::TerminalScreen(bool is_wanted) : is_shown_(is_wanted && isatty(STDERR_FILENO) != 0)
{
    if (is_shown_) std::cerr << kEnter << std::flush;
}

TerminalScreen::~TerminalScreen()
{
    if (is_shown_) std::cerr << kLeave << std::flush;
}

void TerminalScreen::show(const std::vector<std::string>& lines) const
{
    if (!is_shown_) return;
    std::string text = kHome;
    for (std::string line : lines) {
        std::ranges::replace_if(
            line, [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, ' ');
        text += line + kClearRestOfLine + "\r\n";
    }
    std::cerr << text << kClearBelow << std::flush;
}

} // namespace fettle::cli
