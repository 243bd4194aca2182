#pragma once

#include "strategy/steering.h"

#include <string>
#include <termios.h>

namespace fettle::strategy {

/// The keys of a terminal as a stick. An arrow key deflects it for 0.1 s, and longer while the key repeats, so it
/// centres when the key is released; the space bar centres it at once. u: up, or down again; r: record, n: next, q:
/// end; these three take effect when the stick is centred.
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

  private:
    void read_terminal(Stick& stick);

    int terminal_;
    termios saved_settings_ = {};
    std::string input_;       ///< typed, not yet applied
    double release_time_ = 0; ///< of the arrow key, steering time, s
};

} // namespace fettle::strategy
