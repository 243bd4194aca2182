#pragma once

#include "strategy/steering.h"

#include <string>
#include <termios.h>

namespace fettle::strategy {

/// The keys of a terminal as a stick. An arrow key deflects it for 0.1 s, and longer while the key repeats, so it
/// centres when the key is released; the space bar is Button::stop, and centres it. u: up, or down again; q: end; the
/// other buttons are r record, n next, b or backspace back, Enter start, a automatic, m manual, [ and ] turn the head.
/// All but u take effect when the stick is centred.
class Keys {
  public:
    /// Switches the terminal to unbuffered input without echo, and back at the end.
    /// @param terminal  must outlive the keys
    explicit Keys(int terminal);
    ~Keys();
    Keys(const Keys&) = delete;
    Keys& operator=(const Keys&) = delete;

    /// Applies what has been typed up to now. @param time  of the steering, s
    void update(double time, Stick& stick);
    /// True if the space bar or q was typed and has not been applied yet, or if the terminal is closed.
    bool has_stop();
    /// Forgets what has been typed, but for q.
    void discard();

  private:
    void read_terminal();

    int terminal_;
    termios saved_settings_ = {};
    std::string input_;       ///< typed, not yet applied
    bool is_closed_ = false;  ///< the terminal
    double release_time_ = 0; ///< of the arrow key, steering time, s
};

} // namespace fettle::strategy
