#pragma once

#include <string>
#include <vector>

namespace fettle::cli {

/// A screen of text on the terminal of stderr, in place of what was there; that comes back at the end.
class TerminalScreen {
  public:
    /// @param is_wanted  false: nothing is shown
    explicit TerminalScreen(bool is_wanted);
    ~TerminalScreen();
    TerminalScreen(const TerminalScreen&) = delete;
    TerminalScreen& operator=(const TerminalScreen&) = delete;

    /// False if stderr is no terminal.
    bool is_shown() const { return is_shown_; }
    /// Replaces the lines on the screen. Control characters in them are replaced by blanks.
    void show(const std::vector<std::string>& lines) const;

  private:
    bool is_shown_;
};

} // namespace fettle::cli
