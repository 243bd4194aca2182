#pragma once

#include "strategy/steering.h"

#include <string>
#include <termios.h>

namespace fettle {

/// The keys of a terminal as a stick: it stands where an arrow points for 0.1 s, and on while the key repeats; so it
/// rests when the key is let go. Blank: it rests at once. u: up, or down again; r: record, n: next, q: end; these three
/// wait until it rests.
class Keys {
  public:
    /// Until the end keys come one by one and are not shown. @param terminal  must outlive the keys
    explicit Keys(int terminal);
    ~Keys();
    Keys(const Keys&) = delete;
    Keys& operator=(const Keys&) = delete;

    void tell(double time, Stick& stick);

  private:
    void read_waiting(Stick& stick);

    int terminal_;
    termios before_ = {};
    std::string waiting_;
    double rest_at_ = 0; ///< of the steering, s
};

} // namespace fettle
